#pragma once

#include <filesystem>
#include <string>

#include "hires/base/text.h"
#include "support/temporary_folder.h"

namespace hires::test_support {

/// A stool: a wide and light seat on a small and heavy foot. It tips at 1.6 m/s^2 and then rests on
/// foot and rim: it leans by atan(0.027 / 0.056) = 0.45 rad for good, and hardly rocks on its rim.
inline std::string StoolSdf() {
  const auto part = [](const std::string& name, const std::string& size, const std::string& z) {
    return "<collision name='" + name + "'><pose>0 0 " + z + " 0 0 0</pose><geometry><box><size>" +
           size + "</size></box></geometry><surface><friction><ode><mu>1</mu><mu2>1</mu2></ode>" +
           "</friction></surface></collision>";
  };
  return "<?xml version='1.0'?><sdf version='1.7'><model name='stool'><link name='body'>"
         "<inertial><pose>0 0 0.024 0 0 0</pose><mass>0.3</mass><inertia><ixx>0.00006</ixx>"
         "<ixy>0</ixy><ixz>0</ixz><iyy>0.00006</iyy><iyz>0</iyz><izz>0.0001</izz></inertia>"
         "</inertial>" +
         part("foot", "0.008 0.008 0.027", "0.0135") + part("seat", "0.12 0.12 0.01", "0.032") +
         "</link></model></sdf>";
}

/// The package's config, worlds and urdf in a folder of its own. Two things are other than in the
/// package: there is a stool1, and one line of config/scene.yaml may be changed.
class SceneCopy {
 public:
  /// @param from, to  What stands in the file, and what shall stand there; both empty: as it is.
  explicit SceneCopy(const std::string& from = "", const std::string& to = "") {
    namespace fs = std::filesystem;
    const fs::path source = HIRES_SOURCE_DIR;
    LinkAll(source, "config", "scene.yaml");
    LinkAll(source, "worlds", "objects.yaml");
    LinkAll(source, "worlds/models", "");
    fs::create_directory_symlink(source / "urdf", folder_.path() / "urdf");
    std::string scene = base::ReadTextFile((source / "config/scene.yaml").string());
    if (!from.empty()) scene.replace(scene.find(from), from.size(), to);
    path_ = folder_.Write("config/scene.yaml", scene);
    folder_.Write(
        "worlds/objects.yaml",
        base::ReadTextFile((source / "worlds/objects.yaml").string()) + "stool1: stool\n");
    folder_.Write("worlds/models/stool/model.sdf", StoolSdf());
  }
  const std::string& path() const { return path_; }  ///< of scene.yaml

 private:
  /// Everything in a folder of the package, but one entry.
  void LinkAll(const std::filesystem::path& source, const std::string& name,
               const std::string& but) {
    namespace fs = std::filesystem;
    fs::create_directories(folder_.path() / name);
    for (const auto& entry : fs::directory_iterator(source / name)) {
      const fs::path file = entry.path().filename();
      if (file == but || file == "models") continue;
      fs::create_symlink(entry.path(), folder_.path() / name / file);
    }
  }

  TemporaryFolder folder_;
  std::string path_;
};

/// The line of config/scene.yaml that says what a fall is, and another one.
inline constexpr char kStandingLine[] =
    "standing: {tilt: 0.5, hold_time: 0.0, drop: 0.05, slide: 0.10}";
inline constexpr char kOtherStandingLine[] =
    "standing: {tilt: 0.4, hold_time: 0.2, drop: 0.05, slide: 0.10}";
/// A third one: longer than the stool leans in a drive of 1.5 s.
inline constexpr char kLongHoldStandingLine[] =
    "standing: {tilt: 0.4, hold_time: 2.0, drop: 0.05, slide: 0.10}";

}  // namespace hires::test_support
