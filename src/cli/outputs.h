#pragma once

#include <string>
#include <vector>

namespace hires::cli {

/// A file that a verb reads or writes.
struct VerbFile {
  std::string what;            ///< of an output its option, "--json"; of an input what it is, "map"
  std::string path;            ///< empty: none
  bool may_be_printed{false};  ///< of an output: "-" is standard output
};

/// Before the work: each output can be written, is none of the inputs and no other output.
/// @throws base::ConfigError with all that is wrong
void CheckOutputs(const std::vector<VerbFile>& outputs, const std::vector<VerbFile>& inputs);

}  // namespace hires::cli
