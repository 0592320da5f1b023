#pragma once

#include <tinyxml2.h>

#include <functional>
#include <string>

#include "world/sdf/load_notes.h"
#include "world/sdf/sdf_files.h"

namespace hires::world {

/// Elements that stand for others, which libsdformat is not to look at: it would refuse what no
/// question needs, or does not know them.
constexpr char kInertial[] = "hires:inertial";  ///< of a <link>, its children as they are
constexpr char kDensity[] = "hires:density";    ///< of a <collision>
constexpr char kVisual[] = "hires:visual";      ///< there if the link has a <visual>
constexpr char kFloats[] = "hires:floats";      ///< the link is <kinematic> or without gravity
constexpr char kJointType[] = "hires:type";     ///< of a <joint>, which is "fixed" for libsdformat
/// A <joint> whose ends are not there; its text says what is wrong (CheckNames), kPlace where, as
/// libsdformat keeps no lines of such elements.
constexpr char kBrokenJoint[] = "hires:broken_joint";
constexpr char kPlace[] = "hires_place";
constexpr char kMerged[] = "hires:merged";  ///< of an <include merge="true">
constexpr char kShapePrefix[] = "hires:";   ///< <hires:cone> for <cone>, beside <empty/>

/// Leaves only what is read of an SDF file: models, links, collisions, joints, frames, includes and
/// what places them. Lights, plugins, sensors, looks and the like go without a word; what could
/// stand in a robot's way and goes (actors, populations, elements of no known name) is said. A file
/// of a newer SDF 1.x than libsdformat's becomes one of its newest, as only elements that both have
/// are left.
/// @param root  the <sdf> element.
/// @param file  gets version, world_joints, models_beside_world, num_worlds, num_models and
/// model_name.
void PruneSdf(tinyxml2::XMLElement* root, const std::string& path, SdfFile* file, LoadNotes* notes);

/// Says of an element that stands beside <world>, where libsdformat passes it over in silence.
void NoteBesideWorld(const std::string& element, const std::string& place, LoadNotes* notes);

/// Gives a <model> that holds nothing a link, as libsdformat refuses it otherwise.
void FillEmptyModel(tinyxml2::XMLElement* model);

/// The text of an element without white space around it; "" if it is not there.
std::string TrimmedText(const tinyxml2::XMLElement* element);

/// The file that an <include> leads to, which was read.
using FileOfInclude = std::function<const SdfFile&(const tinyxml2::XMLElement& include)>;

/// What a link, model, joint, frame or <include> is called in its world or model: its attribute
/// name; of an <include> its <name>, else what the model of its file is called. "" if it has none.
std::string NameOfPart(const tinyxml2::XMLElement& part, const FileOfInclude& file_of);

}  // namespace hires::world
