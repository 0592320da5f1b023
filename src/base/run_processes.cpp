#include "hires/base/run_processes.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

namespace fs = std::filesystem;

// Below the ports that the kernel gives to outgoing connections.
constexpr int kFirstPort = 20000;
constexpr int kNumBlocks = 120;
constexpr char kLoopback[] = "127.0.0.1";

std::vector<pid_t> Children() {
  std::vector<pid_t> children;
  for (const auto& task : fs::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "children");
    for (pid_t pid = 0; file >> pid;) children.push_back(pid);
  }
  return children;
}

}  // namespace

void AdoptOrphans() { prctl(PR_SET_CHILD_SUBREAPER, 1); }

void StopWithParent() { prctl(PR_SET_PDEATHSIG, SIGTERM); }

void KillDescendants() {
  // A killed process leaves its children to this one, where the next round finds them.
  for (std::vector<pid_t> children = Children(); !children.empty(); children = Children()) {
    for (const pid_t child : children) kill(child, SIGKILL);
    for (const pid_t child : children) {
      while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
  }
}

PortClaim::PortClaim(int size) {
  HIRES_CHECK(size >= 1 && size <= kPortBlock, "a claim is for 1 to 100 ports");
  for (int i = 0; i < kNumBlocks; ++i) {
    if (Claim(kFirstPort + (getpid() + i) % kNumBlocks * kPortBlock, size)) return;
  }
  throw ConfigError(
      fmt::format("no {} ports in a row are free on {} between {} and {}; end what listens there",
                  size, kLoopback, kFirstPort, kFirstPort + kNumBlocks * kPortBlock));
}

PortClaim::~PortClaim() { close(lock_); }

bool PortClaim::Claim(int first, int size) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // An abstract name: it is gone with the socket, in whatever way this process ends.
  const std::string name = fmt::format("hires_ports_{}", first);
  std::memcpy(address.sun_path + 1, name.data(), name.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int lock = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  bool is_free = lock >= 0 && bind(lock, reinterpret_cast<const sockaddr*>(&address), length) == 0;
  for (int i = 0; is_free && i < size; ++i) is_free = IsPortFree(kLoopback, first + i);
  if (!is_free) {
    close(lock);
    return false;
  }
  first_ = first;
  lock_ = lock;
  return true;
}

std::string LastLineOf(const std::string& path) {
  constexpr std::size_t kLongest = 1u << 30;
  std::error_code error;
  if (!fs::exists(path, error)) return "";
  std::string text = ReadTextFile(path, kLongest);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

RunFolder::RunFolder(const std::string& path) : path_(path), is_temporary_(path.empty()) {
  std::error_code error;
  if (is_temporary_) {
    path_ = (fs::temp_directory_path(error) / "hires_run_XXXXXX").string();
    if (!error && mkdtemp(path_.data()) != nullptr) return;
  } else {
    fs::create_directories(path_, error);
    path_ = fs::absolute(path_).string();
    if (!error) return;
  }
  throw ConfigError(
      fmt::format("{}: the folder of a run cannot be made; check rights and space", path_));
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (is_temporary_) fs::remove_all(path_, ignored);
}

}  // namespace hires::base
