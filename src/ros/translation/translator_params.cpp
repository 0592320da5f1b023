#include "hires/ros/translation/translator_params.h"

#include "hires/imagination/imagination_setup.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"
#include "hires/translation/load_context.h"

namespace hires_ros {

namespace imagination = hires::imagination;
namespace translation = hires::translation;

void ReadTranslatorFiles(const std::string& path, hires::base::ParamReader* in,
                         TranslatorParams* params) {
  params->scene = imagination::ResolvePath(in->GetString("scene"), path);
  for (const std::string& file : in->GetStrings("ontology")) {
    params->ontology.push_back(imagination::ResolvePath(file, path));
  }
}

TranslatorParams ReadTranslatorParams(const std::string& path) {
  auto in = hires::base::ParamReader::FromFile(path);
  TranslatorParams params;
  ReadTranslatorFiles(path, &in, &params);
  in.RejectUnknownKeys();
  return params;
}

TranslatorParams LoadTranslatorParams() {
  RejectUnknownPrivate({"config", "world", "robot", "objects", "names"});
  TranslatorParams params = ReadTranslatorParams(ConfigPath("translator"));
  params.world = PrivateText("world").value_or("");
  params.robot = PrivateText("robot").value_or("");
  params.objects = PrivateText("objects").value_or("");
  params.names = LoadRobotNames();
  return params;
}

translation::TranslatorContext LoadTranslatorContext(const TranslatorParams& params) {
  imagination::SetupConfig files = imagination::ReadSetupConfig(params.scene);
  imagination::OverridePaths(params.world, params.robot, params.objects, std::nullopt, &files);
  return translation::LoadContext(
      {files.world, files.robot, files.objects, params.ontology, files.standing, files.classify});
}

}  // namespace hires_ros
