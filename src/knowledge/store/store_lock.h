#pragma once

#include <string>

namespace hires::knowledge {

/// The right to write a store, held by one object on this computer at a time: a lock of the
/// operating system on the file `<path>.lock`, which the kernel gives back when its holder dies,
/// however that happens. The file stays (to remove it would let two holders in); it says who has,
/// or had, the lock.
class WriterLock {
 public:
  /// @throws ConfigError naming the holder if there is one, or why there can be no lock.
  explicit WriterLock(const std::string& path);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  int descriptor_{-1};
};

}  // namespace hires::knowledge
