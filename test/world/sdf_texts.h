#pragma once

#include <fmt/format.h>

#include <string>

namespace hires::world {

/// An SDF world around `content`, which begins in line 3.
inline std::string WorldText(const std::string& content) {
  return "<sdf version='1.7'>\n<world name='test'>\n" + content + "\n</world>\n</sdf>\n";
}

inline std::string StaticModel(const std::string& name, const std::string& links) {
  return fmt::format("<model name='{}'><static>true</static>{}</model>\n", name, links);
}

inline std::string LinkWithShape(const std::string& shape, const std::string& surface = "") {
  return fmt::format(
      "<link name='body'><collision name='c'><geometry>{}</geometry>{}</collision></link>", shape,
      surface);
}

inline const char kUnitBox[] = "<box><size>1 1 1</size></box>";

/// A cube of 1 kg and 0.1 m whose origin is the middle of its lower face.
inline std::string LooseCube(const std::string& name, const std::string& pose = "0 0 0 0 0 0",
                             const std::string& extra = "") {
  return fmt::format(
      "<model name='{}'><pose>{}</pose>{}<link name='body'><inertial><pose>0 0 0.05 0 0 0</pose>"
      "<mass>1</mass><inertia><ixx>0.002</ixx><ixy>0</ixy><ixz>0</ixz><iyy>0.002</iyy><iyz>0</iyz>"
      "<izz>0.002</izz></inertia></inertial><collision name='c'><pose>0 0 0.05 0 0 0</pose>"
      "<geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision></link></model>\n",
      name, pose, extra);
}

inline std::string ModelFile(const std::string& model) {
  return "<sdf version='1.7'>\n" + model + "</sdf>\n";
}

inline std::string ModelConfig(const std::string& name) {
  return fmt::format(
      "<model><name>{}</name><version>1.0</version><sdf version='1.7'>model.sdf</sdf></model>\n",
      name);
}

}  // namespace hires::world
