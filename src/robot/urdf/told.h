#pragma once

#include <string>
#include <vector>

namespace hires::robot {

/// What was changed of one kind in a URDF, told at the end as one line of the log.
class Told {
 public:
  /// @param line  in the file, 0 if none.  @param what  "mass is 0 kg"; may be empty.
  void Add(int line, const std::string& name, const std::string& what);
  /// A warning with all names, their number and the first place; nothing where there are none.
  /// @param where  the file.  @param key  "held_at_0".
  void Tell(const std::string& where, const char* key, const char* reason) const;

 private:
  std::vector<std::string> names_;
  std::string first_;  // "line 7: mass is 0 kg"
};

}  // namespace hires::robot
