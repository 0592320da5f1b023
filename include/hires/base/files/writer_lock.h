#pragma once

#include <string>

namespace hires::base {

/// The right to write a file or a folder, held by one object on this computer at a time: a lock of
/// the operating system on the file `<path>.lock`, which the kernel gives back when its holder
/// dies, however that happens. The file stays (to remove it would let two holders in); it says who
/// has, or had, the lock.
class WriterLock {
 public:
  /// @param otherwise  what else its user can do: "open the store read-only".
  /// @throws ConfigError naming the holder if there is one, or why there can be no lock.
  WriterLock(const std::string& path, const std::string& otherwise);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  int descriptor_{-1};
};

}  // namespace hires::base
