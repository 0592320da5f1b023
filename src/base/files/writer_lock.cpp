#include "hires/base/files/writer_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "hires/base/error.h"

namespace hires::base {
namespace {

/// One file has one lock, by whatever way its folder is named.
std::string LockPath(const std::string& path) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  return (error ? path : canonical.string()) + ".lock";
}

std::string OwnName() {
  std::string name;
  std::getline(std::ifstream("/proc/self/comm"), name);
  return fmt::format("process {} ({})", getpid(), name.empty() ? "unnamed" : name);
}

std::string HolderName(int descriptor) {
  std::array<char, 200> text{};
  const ssize_t size = pread(descriptor, text.data(), text.size(), 0);
  const std::string name(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  return name.empty() ? "another program" : name;
}

}  // namespace

WriterLock::WriterLock(const std::string& path, const std::string& otherwise) {
  const std::string lock = LockPath(path);
  descriptor_ = open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) {
    throw ConfigError(fmt::format(
        "{}: cannot be written, for {} cannot be made ({}); check the folder and its permissions, "
        "or {}",
        path, lock, std::strerror(errno), otherwise));
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const std::string holder = HolderName(descriptor_);
    close(descriptor_);
    throw ConfigError(
        fmt::format("{}: is being written by {}; end that one, or {}", path, holder, otherwise));
  }
  // The name is for the message of the second process: on a full disk it may be missing.
  const std::string name = OwnName();
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, name.data(), name.size(), 0) < 0) {
    return;
  }
}

WriterLock::~WriterLock() { close(descriptor_); }

}  // namespace hires::base
