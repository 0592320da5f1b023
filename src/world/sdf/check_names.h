#pragma once

#include <tinyxml2.h>

#include <functional>
#include <string>

#include "world/sdf/load_notes.h"
#include "world/sdf/sdf_files.h"

namespace hires::world {

/// Makes problems, with lines, of links, models, joints and frames of one name in a <world> or
/// <model>, and of poses that count from what is not there; and puts what is wrong otherwise, so
/// that nobody complains of it again. A joint whose ends are not there is no problem: it becomes a
/// kBrokenJoint, by which its model stands still.
/// @param name_of_file  what the model is called that an <include> leads to.
void CheckNames(tinyxml2::XMLElement* scope, const std::string& path, const std::string& version,
                const std::function<std::string(const tinyxml2::XMLElement&)>& name_of_file,
                LoadNotes* notes);

}  // namespace hires::world
