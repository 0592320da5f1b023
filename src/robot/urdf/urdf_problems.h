#pragma once

#include <map>
#include <string>

namespace hires::robot {

/// What keeps a URDF from being a robot: all of it is told at once, in the order of its lines.
class UrdfProblems {
 public:
  /// @param where  the file, for messages.
  explicit UrdfProblems(const std::string& where) : where_(where) {}

  /// @param line  in the file.  @param what  what is wrong there and what to do, without file and
  /// line. The same is told once.
  void Add(int line, const std::string& what);
  bool empty() const { return problems_.empty(); }
  /// @throws base::ConfigError with all of them, or the first fifty and how many more.
  void ThrowIfAny() const;
  /// At once, with all that was found before: nothing can be read beyond this.
  [[noreturn]] void Fail(int line, const std::string& what);

 private:
  std::string where_;
  std::multimap<int, std::string> problems_;  // by line
};

}  // namespace hires::robot
