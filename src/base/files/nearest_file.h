#pragma once

#include <string>

namespace hires::base {

/// The file below a folder that a path there may have meant, for messages: one of the same name
/// elsewhere, else the one whose path takes the fewest letters to change (case ignored), at most a
/// third of them. Worlds, models and robots are meant by names that end like theirs alone. Some
/// thousand files are looked at.
/// @param folder  is there.  @param wanted  path inside of it that is not.
/// @return relative to `folder`; "" where nothing comes near.
std::string NearestFile(const std::string& folder, const std::string& wanted);

/// " (did you mean 'meshes/torso.obj'?)" for the path of a file that is not there, by what lies in
/// the deepest of its folders that is; "" where nothing there comes near.
std::string DidYouMeanFile(const std::string& path);

}  // namespace hires::base
