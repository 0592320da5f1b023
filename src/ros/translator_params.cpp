#include "hires/ros/translator_params.h"

#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/ros/load_robot_names.h"
#include "hires/ros/private_params.h"
#include "hires/world/object_catalogue.h"

namespace hires_ros {
namespace {

namespace imagination = hires::imagination;
namespace robot = hires::robot;
namespace translation = hires::translation;

robot::Robot LoadAnyRobot(const std::string& path) {
  const std::string ending = ".urdf";
  const bool is_urdf = path.size() > ending.size() &&
                       hires::base::ToLower(path.substr(path.size() - ending.size())) == ending;
  return is_urdf ? robot::LoadRobotFromUrdf(path) : robot::LoadRobot(path);
}

}  // namespace

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
  translation::TranslatorContext context =
      translation::MakeContext(hires::world::LoadWorld(files.world), LoadAnyRobot(files.robot),
                               hires::world::LoadCatalogueModels(files.objects),
                               std::make_shared<const hires::knowledge::Ontology>(
                                   hires::knowledge::Ontology::FromFiles(params.ontology)));
  context.standing = files.standing;
  return context;
}

}  // namespace hires_ros
