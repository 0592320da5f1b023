#include "sim_robot/scenario.h"

#include <cmath>
#include <filesystem>
#include <set>

#include "hires/base/files/named_file.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"

namespace hires::sim_robot {
namespace {

constexpr double kFar = 1000.0;                       // [m] worlds are not larger
constexpr double kHigh = 100.0;                       // [m]
constexpr double kTurn = 6.3;                         // [rad]
constexpr double kColdest = 200.0, kHottest = 600.0;  // [K] what is less is meant in Celsius

std::string GetName(const std::string& key, base::ParamReader* in) {
  const std::string name = base::ToLower(in->GetString(key));
  if (name.empty()) in->Fail(key, "wanted a name");
  return name;
}

std::vector<std::string> PathsFrom(const std::string& file, const std::vector<std::string>& paths) {
  std::vector<std::string> resolved;
  for (const std::string& path : paths) {
    resolved.push_back(
        (std::filesystem::path(file).parent_path() / path).lexically_normal().string());
  }
  return resolved;
}

geometry::Pose2 ReadRobotPose(base::ParamReader* in) {
  const std::vector<double> pose = in->GetNumbers("pose", 3);
  if (std::abs(pose[0]) > kFar || std::abs(pose[1]) > kFar || std::abs(pose[2]) > kTurn) {
    in->Fail("pose", "wanted x and y within 1000 m, yaw within 6.3 rad");
  }
  return {pose[0], pose[1], pose[2]};
}

geometry::Pose3 ReadObjectPose(base::ParamReader* in) {
  const std::vector<double> pose = in->GetNumbers("pose", 4);
  if (std::abs(pose[0]) > kFar || std::abs(pose[1]) > kFar || std::abs(pose[2]) > kHigh ||
      std::abs(pose[3]) > kTurn) {
    in->Fail("pose", "wanted x and y within 1000 m, z within 100 m, yaw within 6.3 rad");
  }
  return geometry::Lift({pose[0], pose[1], pose[3]}, pose[2]);
}

void ReadRobot(base::ParamReader in, Scenario* scenario) {
  scenario->X_MB = ReadRobotPose(&in);
  if (in.Has("torso")) scenario->torso = GetName("torso", &in);
  if (!in.Has("arms")) return;
  base::ParamReader arms = in.Sub("arms");
  for (const std::string& arm : arms.Keys()) {
    scenario->arms[base::ToLower(arm)] = GetName(arm, &arms);
  }
}

void ReadObjects(const std::string& key, bool is_told, base::ParamReader* in,
                 std::set<std::string>* seen, Scenario* scenario) {
  if (!in->Has(key)) return;
  for (base::ParamReader& entry : in->SubList(key)) {
    ScenarioObject object;
    object.name = GetName("name", &entry);
    if (!seen->insert(object.name).second) entry.Fail("name", "wanted every object once");
    if (entry.Has("model")) object.model = GetName("model", &entry);
    object.X_MO = ReadObjectPose(&entry);
    object.is_told = is_told;
    if (entry.Has("temperature")) {
      object.temperature = entry.Get("temperature", base::Between(kColdest, kHottest));
    }
    scenario->objects.push_back(object);
  }
}

}  // namespace

std::string ScenarioPath(const std::string& scenario, const std::string& folder) {
  return base::NamedFile("scenario", scenario, folder);
}

Scenario ReadScenario(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  in.RequireKeys({"task", "knowledge", "robot.pose"});
  Scenario scenario;
  scenario.name = std::filesystem::path(path).stem().string();
  scenario.task = in.GetString("task");
  if (scenario.task.empty()) in.Fail("task", "wanted a task as `hires achieve` takes it");
  scenario.knowledge = PathsFrom(path, in.GetStrings("knowledge"));
  ReadRobot(in.Sub("robot"), &scenario);
  std::set<std::string> seen;
  ReadObjects("objects", true, &in, &seen, &scenario);
  ReadObjects("hidden", false, &in, &seen, &scenario);
  in.RejectUnknownKeys();
  return scenario;
}

std::map<std::string, double> TemperaturesOf(const std::string& scenario) {
  std::map<std::string, double> temperatures;
  if (scenario.empty()) return temperatures;
  for (const ScenarioObject& object : ReadScenario(scenario).objects) {
    if (object.temperature) temperatures[object.name] = *object.temperature;
  }
  return temperatures;
}

}  // namespace hires::sim_robot
