#include "lab/src/graph/process_watch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "hires/base/text.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;

constexpr char kNodeName[] = "__name:=";

/// Empty, or cut off, where the process has gone meanwhile: then reading fails, which streams keep
/// to themselves and iterators over their buffers would throw.
std::string ProcFile(int pid, const char* name) {
  std::ifstream file(fmt::format("/proc/{}/{}", pid, name));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<int> ChildrenOf(int pid) {
  std::vector<int> children;
  std::error_code error;  // the process may go at any time
  fs::directory_iterator task(fmt::format("/proc/{}/task", pid), error);
  for (; !error && task != fs::directory_iterator(); task.increment(error)) {
    std::ifstream file(task->path() / "children");
    for (int child = 0; file >> child;) children.push_back(child);
  }
  return children;
}

void SetName(const std::string& command_line, Descendant* descendant) {
  for (const std::string& word : base::Split(command_line, '\0')) {
    if (descendant->name.empty()) descendant->name = fs::path(word).filename().string();
    if (word.rfind(kNodeName, 0) != 0) continue;
    descendant->name = word.substr(sizeof(kNodeName) - 1);
    descendant->is_node = true;
  }
}

/// The program's own name stands in brackets and may hold anything.
char StateOf(const std::string& stat) {
  const std::size_t end = stat.rfind(')');
  return end == std::string::npos || end + 2 >= stat.size() ? 'Z' : stat[end + 2];
}

}  // namespace

std::vector<Descendant> Descendants() {
  std::vector<Descendant> found;
  std::vector<int> to_visit = ChildrenOf(getpid());
  while (!to_visit.empty()) {
    const int pid = to_visit.back();
    to_visit.pop_back();
    const char state = StateOf(ProcFile(pid, "stat"));
    if (state == 'Z') continue;
    found.push_back({pid, "", false, state});
    SetName(ProcFile(pid, "cmdline"), &found.back());
    const std::vector<int> children = ChildrenOf(pid);
    to_visit.insert(to_visit.end(), children.begin(), children.end());
  }
  return found;
}

BreakdownWatch::BreakdownWatch(double stopped_limit) : stopped_limit_(stopped_limit) {
  for (const Descendant& each : Descendants()) names_[each.pid] = each.name;
}

std::optional<std::string> BreakdownWatch::Broken(double now) {
  std::map<int, char> states;
  for (const Descendant& each : Descendants()) {
    states[each.pid] = each.state;
    if (each.is_node) names_.emplace(each.pid, each.name);
  }
  for (const auto& [pid, name] : names_) {
    const auto state = states.find(pid);
    if (state == states.end()) return fmt::format("{} (pid {}) died", name, pid);
    if (state->second != 'T') {
      stopped_.erase(pid);
      continue;
    }
    const double since = stopped_.emplace(pid, now).first->second;
    if (now - since < stopped_limit_) continue;
    return fmt::format("{} (pid {}) is stopped since {:g} s", name, pid, stopped_limit_);
  }
  return std::nullopt;
}

}  // namespace hires::lab
