#include "robot/urdf/urdf_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <filesystem>

#include "base/captured_program.h"
#include "base/files/package_finder.h"
#include "base/files/plain_xml.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "robot/urdf/clean_urdf.h"

namespace hires::robot {
namespace {

namespace fs = std::filesystem;

constexpr char kProgram[] = "xacro";
constexpr char kPrefix[] = "xacro:";
constexpr std::size_t kMaxUrdfBytes = 16u << 20;
constexpr std::size_t kMostSaid = 4000;  // letters of what xacro says that are passed on

bool IsFile(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool HasXacroEnding(const std::string& path) {
  return base::ToLower(fs::path(path).extension().string()) == ".xacro";
}

bool HasMacro(const char* text) {
  if (text == nullptr) return false;
  const std::string words = text;
  return words.find("${") != std::string::npos || words.find("$(") != std::string::npos;
}

/// Goes through what a robot is read from until it meets what xacro would expand: looks, plugins,
/// transmissions and comments are no part of the walk.
class MacroFinder : public tinyxml2::XMLVisitor {
 public:
  bool VisitEnter(const tinyxml2::XMLElement& element,
                  const tinyxml2::XMLAttribute* attribute) override {
    const std::string name = element.Name();
    const bool is_macro = name.rfind(kPrefix, 0) == 0;
    if (!is_macro && !IsRead(element, name)) return false;
    has_macro = has_macro || is_macro;
    for (; attribute != nullptr; attribute = attribute->Next())
      has_macro = has_macro || HasMacro(attribute->Value());
    return !has_macro && name != "sensor";
  }
  bool Visit(const tinyxml2::XMLText& text) override {
    has_macro = has_macro || HasMacro(text.Value());
    return !has_macro;
  }

  bool has_macro{false};

 private:
  /// Of <gazebo>, the link, its friction and whether a sensor is a laser.
  static bool IsRead(const tinyxml2::XMLElement& element, const std::string& name) {
    const tinyxml2::XMLNode* parent = element.Parent();
    const bool is_root = parent == nullptr || parent->ToElement() == nullptr;
    if (is_root) return true;
    const std::string above = parent->ToElement()->Name();
    if (above == "robot" && name == "gazebo") return true;
    if (above == "gazebo") return name == "mu1" || name == "mu2" || name == "sensor";
    return IsKept(above, name);
  }
};

/// In double quotes where a shell would take it apart.
std::string Quoted(const std::string& word) {
  const bool is_plain =
      !word.empty() && word.find_first_of(" \t\n'\"\\$`*?[]()<>|&;!{}~#") == std::string::npos;
  if (is_plain) return word;
  std::string quoted = "'";
  for (const char letter : word)
    quoted += letter == '\'' ? std::string("'\\''") : std::string{letter};
  return quoted + "'";
}

/// "bot.urdf" for bot.urdf.xacro and bot.xacro; "bot.expanded.urdf" for bot.urdf.
std::string UrdfNameFor(const std::string& path) {
  if (!HasXacroEnding(path)) return fs::path(path).replace_extension(".expanded.urdf").string();
  const std::string stem = fs::path(path).replace_extension().string();
  return base::ToLower(fs::path(stem).extension().string()) == ".urdf" ? stem : stem + ".urdf";
}

std::string CommandFor(const UrdfFile& file) {
  std::string command = "rosrun xacro xacro " + Quoted(file.path);
  for (const std::string& argument : file.arguments) command += " " + Quoted(argument);
  return command + " > " + Quoted(UrdfNameFor(file.path));
}

/// Without the colours of a terminal and blank ends, and no longer than people read.
std::string Said(const std::string& errors) {
  std::string plain;
  for (std::size_t at = 0; at < errors.size();) {
    const std::size_t escape = std::min(errors.find("\x1b[", at), errors.size());
    plain += errors.substr(at, escape - at);
    const std::size_t end = errors.find('m', escape);
    at = end == std::string::npos ? errors.size() : end + 1;
  }
  plain.erase(plain.find_last_not_of(" \t\r\n") + 1);
  return plain.size() > kMostSaid ? plain.substr(0, kMostSaid) + " ..." : plain;
}

[[noreturn]] void FailXacro(const UrdfFile& file, const std::string& what,
                            const std::string& said) {
  throw base::ConfigError(fmt::format("{}: xacro {}: {}; correct that there, `{}` shows it too",
                                      file.path, what, said.empty() ? "it says nothing" : said,
                                      CommandFor(file)));
}

std::string Expanded(const UrdfFile& file) {
  const std::string program = base::ProgramOnPath(kProgram);
  if (program.empty()) {
    throw base::ConfigError(fmt::format(
        "{}: is a xacro file, and there is no program xacro on PATH that would expand it; install "
        "ROS's own package xacro (Debian's packages of ROS have none), or make a URDF of it where "
        "xacro is, and give that: {}",
        file.path, CommandFor(file)));
  }
  // What begins with a dash would be an option.
  const std::string path = file.path.rfind('-', 0) == 0 ? "./" + file.path : file.path;
  std::vector<std::string> command{program, path};
  command.insert(command.end(), file.arguments.begin(), file.arguments.end());
  const base::ProgramOutput result = base::RunAndCapture(command, kXacroLimit);
  const std::string said = Said(result.errors);
  if (result.has_run_out_of_time) {
    FailXacro(file, fmt::format("took longer than {:g} s and was ended", kXacroLimit), said);
  }
  if (!result.exit_code) FailXacro(file, "was ended by a signal", said);
  if (*result.exit_code != 0)
    FailXacro(file, fmt::format("failed with exit code {}", *result.exit_code), said);
  if (result.out.find('<') == std::string::npos) FailXacro(file, "wrote no URDF", said);
  if (!said.empty()) {
    base::Log(base::LogLevel::kWarn, fmt::format("xacro={} says=\"{}\"", file.path, said));
  }
  return result.out;
}

/// xacro itself puts in what entities stand for, so that they are no reason to refuse its files.
std::string PlainOrSame(const std::string& text, const std::string& path) {
  try {
    return base::PlainXml(text, path);
  } catch (const base::ConfigError&) {
    return text;
  }
}

}  // namespace

UrdfFile SplitArguments(const std::string& path_and_arguments) {
  UrdfFile file{path_and_arguments, {}};
  while (!IsFile(file.path)) {
    const std::size_t blank = file.path.find_last_of(" \t\n");
    if (blank == std::string::npos) break;
    const std::string last = file.path.substr(blank + 1);
    if (!last.empty() && last.find(":=") == std::string::npos) break;
    if (!last.empty()) file.arguments.insert(file.arguments.begin(), last);
    file.path.erase(blank);
  }
  return file;
}

bool IsXacro(const std::string& text, const std::string& path) {
  if (HasXacroEnding(path)) return true;
  const std::string plain = PlainOrSame(text, path);
  tinyxml2::XMLDocument document;
  if (document.Parse(plain.data(), plain.size()) != tinyxml2::XML_SUCCESS) return false;
  MacroFinder finder;
  document.Accept(&finder);
  return finder.has_macro;
}

std::string TextOf(const UrdfFile& file) {
  std::vector<std::string> words{file.path};
  words.insert(words.end(), file.arguments.begin(), file.arguments.end());
  return base::Join(words, " ");
}

UrdfFile UrdfOf(const std::string& profile_path, const RobotProfile& profile) {
  UrdfFile file = SplitArguments(profile.urdf);
  const fs::path folder = fs::path(SplitArguments(profile_path).path).parent_path();
  if (file.path.rfind("package://", 0) == 0) {
    file.path = base::PackageFinder().Find(file.path, {fs::absolute(folder).string()});
    return file;
  }
  file.path = (folder / file.path).lexically_normal().string();
  return file;
}

std::string ReadUrdfFile(const UrdfFile& file) {
  const std::string text = base::ReadTextFile(file.path, kMaxUrdfBytes);
  if (IsXacro(text, file.path)) return Expanded(file);
  if (file.arguments.empty()) return text;
  throw base::ConfigError(
      fmt::format("{}: is no xacro file, which alone takes arguments ({}); leave them out",
                  file.path, base::Join(file.arguments, " ")));
}

}  // namespace hires::robot
