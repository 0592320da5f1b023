#include "world/sdf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <optional>
#include <sdf/Console.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/World.hh>
#include <sdf/parser.hh>
#include <set>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/progress.h"
#include "hires/base/text.h"
#include "hires/geometry/inertia.h"
#include "world/console_bridge_capture.h"
#include "world/quick_sdf.h"
#include "world/world_parts.h"

namespace hires::world {
namespace {

/// Drops "\x1b[1;31m" and the like.
std::string WithoutColours(const std::string& text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t escape = std::min(text.find("\x1b[", at), text.size());
    plain += text.substr(at, escape - at);
    const std::size_t end = text.find('m', escape);
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return plain;
}

bool BeginsMessage(const std::string& line) {
  const auto begins_with = [&line](const char* label) { return line.rfind(label, 0) == 0; };
  return begins_with("Error [") || begins_with("Warning [") || begins_with("Msg [");
}

/// libsdformat reports part of its findings only on a console that all threads share. This takes
/// the console for itself, one thread at a time, and keeps what is said.
class ConsoleCapture {
 public:
  ConsoleCapture() : lock_(mutex()), console_(sdf::Console::Instance()) {
    console_->SetQuiet(false);
    console_->GetMsgStream().SetStream(&text_);
    console_->GetLogStream().SetStream(nullptr);  // else each load grows a file in the home folder
  }
  ~ConsoleCapture() {
    console_->GetMsgStream().SetStream(nullptr);  // silent also after us
  }
  ConsoleCapture(const ConsoleCapture&) = delete;
  ConsoleCapture& operator=(const ConsoleCapture&) = delete;

  bool IsSilent() const { return text_.str().empty(); }
  void Forget() { text_.str(""); }

  /// What was said, an item per message, colours dropped.
  std::vector<std::string> Messages() const {
    std::vector<std::string> messages;
    for (const std::string& line : base::Split(WithoutColours(text_.str()), '\n')) {
      if (messages.empty() || BeginsMessage(line)) {
        messages.push_back(line);
      } else if (!line.empty()) {
        messages.back() += " " + line;
      }
    }
    return messages;
  }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  sdf::ConsolePtr console_;
  std::ostringstream text_;
};

/// "Error [parser.cc:12] text" -> "text"; empty if the message has another label.
std::string TextAfter(const std::string& label, const std::string& message) {
  if (message.compare(0, label.size() + 2, label + " [") != 0) return "";
  const std::size_t end = message.find(']');
  const std::size_t begin =
      end == std::string::npos ? std::string::npos : message.find_first_not_of(": ", end + 1);
  return begin == std::string::npos ? "" : message.substr(begin);
}

/// What libsdformat objected to, in the order of discovery, each once.
class Objections {
 public:
  explicit Objections(const std::string& path) : path_(path) {}

  void Add(const sdf::Errors& errors) {
    for (const sdf::Error& error : errors) {
      std::string line = error.FilePath().value_or(path_);
      if (error.LineNumber()) line += fmt::format(":{}", *error.LineNumber());
      AddLine(line + ": " + error.Message(), IsEcho(error.Message()));
    }
  }
  void AddLine(const std::string& line, bool is_echo = false) {
    std::vector<std::string>& lines = is_echo ? echoes_ : lines_;
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  void ThrowIfAny() const {
    // The innermost echo comes first and has the line.
    std::vector<std::string> lines(echoes_.begin(), echoes_.begin() + (echoes_.empty() ? 0 : 1));
    lines.insert(lines.end(), lines_.begin(), lines_.end());
    if (lines.empty()) return;
    throw base::ConfigError(
        fmt::format("{}: no valid SDF; correct:\n  {}", path_, base::Join(lines, "\n  ")));
  }

 private:
  /// Each element around a wrong one reports it again.
  static bool IsEcho(const std::string& message) {
    return message.find("Error reading element") == 0 || message.find("Unable to read file") == 0 ||
           message.find("Failed to load a world") == 0;
  }

  std::string path_;
  std::vector<std::string> lines_, echoes_;
};

void AddConsole(const ConsoleCapture& console, const std::string& path, Objections* objections) {
  const std::vector<std::string> messages = console.Messages();
  for (const std::string& message : std::set<std::string>(messages.begin(), messages.end())) {
    const std::string error = TextAfter("Error", message);
    const std::string warning = TextAfter("Warning", message);
    if (!error.empty()) objections->AddLine(error);
    if (!warning.empty()) {
      base::Log(base::LogLevel::kWarn, fmt::format("world={} sdformat=\"{}\"", path, warning));
    }
  }
}

double NumberOr(const sdf::ElementPtr& parent, const std::string& name, double otherwise) {
  return parent->HasElement(name) ? parent->GetElement(name)->Get<double>() : otherwise;
}

/// libsdformat refuses an impossible inertia as well, but does not say where and why.
void CheckInertial(const sdf::ElementPtr& inertial) {
  if (!inertial->HasElement("inertia")) return;
  const sdf::ElementPtr inertia = inertial->GetElement("inertia");
  geometry::MassProperties properties;
  properties.mass = NumberOr(inertial, "mass", 1.0);
  const char* names[3][3] = {{"ixx", "ixy", "ixz"}, {"ixy", "iyy", "iyz"}, {"ixz", "iyz", "izz"}};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      properties.I_BBcm(i, k) = NumberOr(inertia, names[i][k], i == k ? 1.0 : 0.0);
    }
  }
  const std::string wrong = geometry::WhyUnphysical(properties);
  if (wrong.empty()) return;
  throw base::ConfigError(fmt::format("{}: link '{}': {}; correct its <inertial>",
                                      PlaceOf(inertial),
                                      inertial->GetParent()->Get<std::string>("name"), wrong));
}

void CheckInertials(const sdf::ElementPtr& element) {
  if (element->GetName() == "inertial") CheckInertial(element);
  for (auto child = element->GetFirstElement(); child != nullptr; child = child->GetNextElement()) {
    CheckInertials(child);
  }
}

sdf::ParserConfig ConfigFor(const ResourceFinder& finder) {
  sdf::ParserConfig config;
  // With these, libsdformat looks where the walk looked, before any place of its own.
  config.AddURIPath("model://", base::Join(finder.model_folders(), ":"));
  config.AddURIPath("package://", base::Join(finder.package_folders(), ":"));
  config.AddURIPath("file://", "/");
  config.SetFindCallback([&finder](const std::string& uri) { return finder.FindModel(uri, uri); });
  return config;
}

/// Nothing if libsdformat had anything to say.
std::optional<sdf::Root> LoadQuickly(const sdf::SDFPtr& document, const ResourceFinder& finder,
                                     const ConsoleCapture& console) {
  if (document == nullptr || !console.IsSilent()) return std::nullopt;
  CheckInertials(document->Root());
  sdf::Root root;
  if (!root.Load(document, ConfigFor(finder)).empty() || !console.IsSilent()) return std::nullopt;
  return root;
}

sdf::Root ReadStraight(const std::string& path, const ResourceFinder& finder,
                       const ConsoleCapture& console) {
  const sdf::ParserConfig config = ConfigFor(finder);
  Objections objections(path);
  sdf::Root root;
  try {
    sdf::Errors errors;
    const sdf::SDFPtr document = sdf::readFile(path, config, errors);
    if (document != nullptr && errors.empty()) {
      CheckInertials(document->Root());
      errors = root.Load(document, config);
    }
    objections.Add(errors);
    if (document == nullptr) objections.AddLine(path + ": is no SDF document", true);
  } catch (const base::ConfigError&) {
    throw;
  } catch (const std::exception& error) {
    objections.AddLine(error.what());
  }
  AddConsole(console, path, &objections);
  objections.ThrowIfAny();
  return root;
}

/// The quick way if libsdformat is content; else the straight one repeats what it had to say.
sdf::Root ReadWhole(const std::string& path, const ResourceFinder& finder,
                    const XmlInventory& inventory, ConsoleCapture* console) {
  const sdf::SDFPtr document = QuickReader(finder, inventory).Read(path);
  if (auto root = LoadQuickly(document, finder, *console)) return std::move(*root);
  console->Forget();
  return ReadStraight(path, finder, *console);
}

using UsePart = std::function<void(const SdfWorldPart&)>;

/// @return whether libsdformat was content with all parts.
bool ReadInParts(const std::vector<WorldPart>& parts, const std::string& path,
                 const ResourceFinder& finder, const XmlInventory& inventory,
                 const ConsoleCapture& console, const UsePart& use) {
  QuickReader reader(finder, inventory);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto root = LoadQuickly(reader.ReadPart(parts[i].text, path), finder, console);
    if (!root || root->WorldCount() != 1) return false;
    const sdf::World& world = *root->WorldByIndex(0);
    if (world.ModelCount() != parts[i].places.size()) return false;
    use({world, parts[i].places, i == 0});
    base::ReportProgress("reading " + path, static_cast<double>(i + 1) / parts.size());
  }
  return true;
}

}  // namespace

std::string PlaceOf(const sdf::ElementPtr& element) {
  if (element == nullptr) return "";
  const auto line = element->LineNumber();
  return line ? fmt::format("{}:{}", element->FilePath(), *line) : element->FilePath();
}

void ThrowIfAny(const sdf::Errors& errors, const std::string& path) {
  Objections objections(path);
  objections.Add(errors);
  objections.ThrowIfAny();
}

sdf::Root ReadSdf(const std::string& path, const ResourceFinder& finder, const XmlLimits& limits,
                  ReadingWay way) {
  ConsoleCapture console;
  const ConsoleBridgeCapture urdf_console;  // libsdformat tries what it cannot read as URDF
  const XmlInventory inventory = CheckXmlFile(path, finder, limits);
  if (way == ReadingWay::kStraight) return ReadStraight(path, finder, console);
  return ReadWhole(path, finder, inventory, &console);
}

void ReadSdfWorld(const std::string& path, const ResourceFinder& finder,
                  std::size_t models_per_part,
                  const std::function<void(const SdfWorldPart&)>& use) {
  ConsoleCapture console;
  const ConsoleBridgeCapture urdf_console;
  const XmlLimits limits;
  const XmlInventory inventory = CheckXmlFile(path, finder, limits);
  if (inventory.at(path).root == "robot") {
    throw base::ConfigError(fmt::format(
        "{}: this is a robot (URDF), wanted a world (SDF); give it with --robot", path));
  }
  const auto parts = CutWorld(base::ReadTextFile(path, limits.max_file_bytes), models_per_part);
  if (!parts.empty() && ReadInParts(parts, path, finder, inventory, console, use)) return;
  console.Forget();
  const sdf::Root root = ReadWhole(path, finder, inventory, &console);
  if (root.WorldCount() != 1) {
    throw base::ConfigError(
        fmt::format("{}: has {} <world> elements, wanted 1", path, root.WorldCount()));
  }
  const sdf::World& world = *root.WorldByIndex(0);
  std::vector<std::size_t> places(world.ModelCount());
  std::iota(places.begin(), places.end(), 0);
  use({world, places, true});
}

}  // namespace hires::world
