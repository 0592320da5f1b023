#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world {

inline const char kBadInertial[] =
    "<inertial><mass>10</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>9</izz></inertia>"
    "</inertial>";

inline std::string Inertial(double mass, double moment) {
  return fmt::format(
      "<inertial><mass>{}</mass><inertia><ixx>{}</ixx><iyy>{}</iyy><izz>{}</izz></inertia>"
      "</inertial>",
      mass, moment, moment, moment);
}

inline std::string Link(const std::string& name, const std::string& pose, const std::string& more,
                        const std::string& shape = kUnitBox) {
  return fmt::format(
      "<link name='{}'><pose>{}</pose>{}<collision name='c'><geometry>{}</geometry></collision>"
      "</link>",
      name, pose, more, shape);
}

inline std::string Joint(const std::string& type, const std::string& parent,
                         const std::string& child) {
  return fmt::format("<joint name='j_{}' type='{}'><parent>{}</parent><child>{}</child></joint>",
                     child.substr(0, 1), type, parent, child);
}

inline std::string Model(const std::string& name, const std::string& content) {
  return fmt::format("<model name='{}'>{}</model>\n", name, content);
}

/// An OBJ of two cubes, from x = 0 and from x = 5 m.
inline const char kTwoCubes[] =
    "o left\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    "o right\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\nv 5 0 1\nv 6 0 1\nv 6 1 1\nv 5 1 1\n"
    "f 9 12 11 10\nf 13 14 15 16\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\n";

/// Worlds as people have them: what no question needs refuses nothing, and what is left out is
/// said.
class WildWorld : public testing::Test {
 protected:
  WildWorld() {
    base::SetLogSink([this](base::LogLevel, const std::string& line) { log_ += line + "\n"; });
  }
  ~WildWorld() override { base::SetLogSink({}); }

  World Load(const std::string& content, const std::string& version = "1.7") const {
    std::string text = WorldText(content);
    text.replace(text.find("1.7"), 3, version);
    return LoadWorld(folder_.Write("test.world", text));
  }
  std::string ErrorOf(const std::string& content, const std::string& version = "1.7") const {
    return MessageOf<base::ConfigError>([&] { Load(content, version); });
  }
  void WriteModel(const std::string& name, const std::string& model,
                  const std::string& folder = "models") const {
    folder_.Write(folder + "/" + name + "/model.sdf", ModelFile(model));
    folder_.Write(folder + "/" + name + "/model.config", ModelConfig(name));
  }

  TempFolder folder_;
  std::string log_;
};

}  // namespace hires::world
