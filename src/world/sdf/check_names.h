#pragma once

#include <tinyxml2.h>

#include <string>

#include "world/sdf/load_notes.h"
#include "world/sdf/prune_sdf.h"

namespace hires::world {

/// Makes problems, with lines, of links, models, joints and frames of one name in a <world> or
/// <model>, and of poses that count from what is not there; and puts what is wrong otherwise, so
/// that nobody complains of it again. A joint whose ends are not there is no problem: it becomes a
/// kBrokenJoint, by which its model stands still.
/// @param file_of  that an <include> leads to.
void CheckNames(tinyxml2::XMLElement* scope, const std::string& path, const std::string& version,
                const FileOfInclude& file_of, LoadNotes* notes);

}  // namespace hires::world
