#include "hires/control/move_base_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::control {
namespace {

using base::ConfigError;

[[noreturn]] void FailToWrite(const std::string& path) {
  throw ConfigError(
      fmt::format("{}: cannot be written: {}; limits of move_base are changed only when what they "
                  "were is on disk. Make the folder writable or name another file as ~journal",
                  path, std::strerror(errno)));
}

/// An open file or folder.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags)
      : fd_(open(path.c_str(), flags | O_CLOEXEC, 0644)) {
    if (fd_ < 0) FailToWrite(path);
  }
  ~Descriptor() { close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

void WriteDurably(const std::string& path, const std::string& text) {
  const Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t n = write(file.get(), text.data() + written, text.size() - written);
    if (n < 0 && errno != EINTR) FailToWrite(path);
    if (n > 0) written += n;
  }
  if (fsync(file.get()) != 0) FailToWrite(path);
}

/// A file's new name is on the disk when its folder is.
void SyncFolderOf(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const Descriptor opened(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
  if (fsync(opened.get()) != 0) FailToWrite(path);
}

void MakeFolderOf(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  errno = error.value();
  FailToWrite(path);
}

std::string TextOf(const MoveBaseJournal& journal) {
  YAML::Emitter out;
  out.SetDoublePrecision(17);  // what is put back is what was there, to the last bit
  out << YAML::Comment(
      "Limits of move_base's local planner that were changed while the robot drives. They are put\n"
      "back at the end of the drive, or when base_guard starts next; then this file goes.");
  out << YAML::BeginMap << YAML::Key << "server" << YAML::Value << journal.server;
  out << YAML::Key << "motion_set" << YAML::Value << journal.set_name;
  out << YAML::Key << "parameters" << YAML::Value << YAML::BeginMap;
  for (const auto& [name, value] : journal.original) {
    out << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginMap;
    out << YAML::Key << "original" << YAML::Value << value;
    out << YAML::Key << "in_force" << YAML::Value << journal.in_force.at(name) << YAML::EndMap;
  }
  out << YAML::EndMap << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

/// Reads a journal's text; keeps what it got until something was wrong, for the message.
class Reader {
 public:
  Reader(const std::string& path, const std::string& text) : path_(path), text_(text) {}

  MoveBaseJournal Read() {
    const YAML::Node root = Parse();
    if (!root.IsMap()) Fail(root, "is no map; wanted server, motion_set and parameters");
    for (const auto& entry : root) RequireKnown(entry.first);
    journal_.server = Text(root, "server");
    journal_.set_name = Text(root, "motion_set");
    ReadParameters(root["parameters"], root);
    return journal_;
  }

 private:
  YAML::Node Parse() {
    try {
      return YAML::Load(text_);
    } catch (const YAML::Exception& error) {
      FailAt(error.mark.line, "is no YAML: " + error.msg);
    }
  }

  void RequireKnown(const YAML::Node& key) {
    static const std::set<std::string> known{"server", "motion_set", "parameters"};
    if (known.count(key.as<std::string>("")) == 0) {
      Fail(key, fmt::format("has '{}', which is no key of it", key.as<std::string>("?")));
    }
  }

  std::string Text(const YAML::Node& root, const std::string& key) {
    const std::string text = root[key] ? root[key].as<std::string>("") : "";
    if (text.empty()) Fail(root, fmt::format("has no {}", key));
    return text;
  }

  void ReadParameters(const YAML::Node& parameters, const YAML::Node& root) {
    if (!parameters || !parameters.IsMap() || parameters.size() == 0) {
      Fail(root, "has no parameters");
    }
    for (const auto& entry : parameters) {
      const std::string name = entry.first.as<std::string>();
      if (!entry.second.IsMap() || entry.second.size() != 2) {
        Fail(entry.first, fmt::format("{} is no pair of original and in_force", name));
      }
      const double original = Number(entry.second, name, "original");
      journal_.in_force[name] = Number(entry.second, name, "in_force");
      journal_.original[name] = original;
    }
  }

  double Number(const YAML::Node& entry, const std::string& name, const std::string& key) {
    const double value = entry[key] ? entry[key].as<double>(NAN) : NAN;
    if (std::isfinite(value)) return value;
    Fail(entry, fmt::format("{}: {} is {}, wanted a number", name, key,
                            entry[key] ? "'" + YAML::Dump(entry[key]) + "'" : "missing"));
  }

  [[noreturn]] void Fail(const YAML::Node& node, const std::string& what) {
    FailAt(node.Mark().line, what);
  }

  [[noreturn]] void FailAt(int line, const std::string& what) {
    throw ConfigError(fmt::format(
        "{}: line {}: {}. It tells what limits of move_base were before they were changed; could "
        "be read of it: {}. Set the limits right by hand (rosrun dynamic_reconfigure dynparam "
        "set), then remove the file; until then move_base is not used",
        path_, line + 1, what, WhatCouldBeRead()));
  }

  /// For people; where nothing was understood, they may understand the text itself.
  std::string WhatCouldBeRead() const {
    if (!journal_.original.empty()) return journal_.server + ": " + ToText(journal_.original);
    constexpr std::size_t kMost = 500;
    const std::vector<std::string> lines =
        base::Split(std::string_view(text_).substr(0, kMost), '\n');
    return "\"" + base::Join(lines, " / ") + "\"";
  }

  const std::string& path_;
  const std::string& text_;
  MoveBaseJournal journal_;
};

}  // namespace

bool MoveBaseJournal::operator==(const MoveBaseJournal& other) const {
  return server == other.server && set_name == other.set_name && original == other.original &&
         in_force == other.in_force;
}

void WriteJournal(const std::string& path, const MoveBaseJournal& journal) {
  MakeFolderOf(path);
  const std::string next = path + ".new";
  WriteDurably(next, TextOf(journal));
  if (std::rename(next.c_str(), path.c_str()) != 0) FailToWrite(path);
  SyncFolderOf(path);
}

std::optional<MoveBaseJournal> ReadJournal(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0 && (errno == ENOENT || errno == ENOTDIR)) {
    return std::nullopt;
  }
  const std::string text = base::ReadTextFile(path, 1u << 20);
  return Reader(path, text).Read();
}

void RemoveJournal(const std::string& path) {
  if (unlink(path.c_str()) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return;
    throw ConfigError(fmt::format("{}: cannot be removed: {}; what it says has been put back", path,
                                  std::strerror(errno)));
  }
  SyncFolderOf(path);
}

std::string DefaultJournalPath() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  const std::string ros_home = variable("ROS_HOME");
  const std::string home = ros_home.empty() ? variable("HOME") + "/.ros" : ros_home;
  return home + "/hires/move_base_originals.yaml";
}

}  // namespace hires::control
