#include "world/sdf_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <optional>
#include <sdf/Console.hh>
#include <sdf/World.hh>
#include <set>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/progress.h"
#include "hires/base/text.h"
#include "world/console_bridge_capture.h"
#include "world/quick_sdf.h"
#include "world/sdf/file_kind.h"
#include "world/sdf/prune_sdf.h"
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

/// What it cannot read, libsdformat tries as older formats and as URDF, and tells how that fails.
bool IsSecondTry(const std::string& error) {
  return error.find("parse as old deprecated model file") != std::string::npos ||
         error.find("Unable to call parseURDF") != std::string::npos;
}

void AddConsole(const ConsoleCapture& console, const std::string& path, LoadNotes* notes) {
  const std::vector<std::string> messages = console.Messages();
  for (const std::string& message : std::set<std::string>(messages.begin(), messages.end())) {
    const std::string error = TextAfter("Error", message);
    const std::string warning = TextAfter("Warning", message);
    if (!error.empty() && !IsSecondTry(error)) notes->AddProblem(path + ": " + error);
    if (!warning.empty()) {
      base::Log(base::LogLevel::kWarn, fmt::format("world={} sdformat=\"{}\"", path, warning));
    }
  }
}

/// What libsdformat makes of a document; what it objects to becomes problems.
std::optional<sdf::Root> Load(const sdf::SDFPtr& document, const std::string& path,
                              LoadNotes* notes) {
  if (document == nullptr) return std::nullopt;
  sdf::Root root;
  try {
    AddErrors(root.Load(document), path, notes);
  } catch (const std::exception& error) {
    notes->AddProblem(fmt::format("{}: libsdformat cannot read it: {}", path, error.what()));
    return std::nullopt;
  }
  return root;
}

/// The text of a file of one static model alone as a world that has it, line by line; "" of others.
std::string AsWorld(const SdfFile& file) {
  tinyxml2::XMLDocument document;
  document.Parse(file.text.data(), file.text.size());
  const tinyxml2::XMLElement* root = document.RootElement();
  const auto* model = root == nullptr ? nullptr : root->FirstChildElement("model");
  if (file.num_worlds != 0 || file.num_models != 1 || model == nullptr) return "";
  const std::string is_static = base::ToLower(TrimmedText(model->FirstChildElement("static")));
  if (is_static != "1" && is_static != "true") return "";
  std::string text = file.text;
  text.insert(text.rfind("</sdf>"), "</world>");
  text.insert(text.find("<model"), "<world name=\"one_model\">");
  return text;
}

/// Reads parts of a world, and hands them on.
class PartsReader {
 public:
  PartsReader(const SdfFiles& files, const std::string& path, LoadNotes* notes,
              const std::function<void(const SdfWorldPart&)>& use)
      : reader_(files, notes), path_(path), notes_(notes), use_(use) {}

  /// A part that libsdformat refuses is read model by model, so that what is wrong with one keeps
  /// nothing from being said of the others.
  void Read(const WorldPart& part, bool is_first) {
    const sdf::SDFPtr document = reader_.ReadPart(part.text, path_);
    if (document != nullptr) {
      Use(document, part.places, is_first);
      return;
    }
    const std::vector<WorldPart> smaller = CutWorld(part.text, 1);
    for (std::size_t i = 0; i < smaller.size(); ++i) {
      std::vector<std::size_t> places = smaller[i].places;
      for (std::size_t& place : places) {
        if (place < part.places.size()) place = part.places[place];
      }
      Use(reader_.ReadPart(smaller[i].text, path_), places, is_first && i == 0);
    }
  }

 private:
  /// @param places  empty for a whole world.
  void Use(const sdf::SDFPtr& document, std::vector<std::size_t> places, bool is_first) {
    const std::optional<sdf::Root> root = Load(document, path_, notes_);
    if (!root || root->WorldCount() == 0) return;
    const sdf::World& world = *root->WorldByIndex(0);
    if (places.size() != world.ModelCount()) {  // the whole, or some could not be read
      places.resize(world.ModelCount());
      std::iota(places.begin(), places.end(), 0);
    }
    use_({world, places, is_first});
  }

  QuickReader reader_;
  const std::string& path_;
  LoadNotes* notes_;
  const std::function<void(const SdfWorldPart&)>& use_;
};

}  // namespace

std::string PlaceOf(const sdf::ElementPtr& element) {
  if (element == nullptr) return "";
  const auto line = element->LineNumber();
  return line ? fmt::format("{}:{}", element->FilePath(), *line) : element->FilePath();
}

void ThrowIfAny(const sdf::Errors& errors, const std::string& path) {
  if (errors.empty()) return;
  LoadNotes notes;
  AddErrors(errors, path, &notes);
  notes.ThrowIfProblems(path);
}

std::optional<sdf::Root> ReadSdf(const std::string& path, const ResourceFinder& finder,
                                 LoadNotes* notes, const XmlLimits& limits) {
  ConsoleCapture console;
  const ConsoleBridgeCapture urdf_console;  // an included URDF is read by urdfdom
  const SdfFiles files = ReadSdfFiles(path, finder, limits, notes);
  if (files.at(path).root != "sdf") {
    throw base::ConfigError(
        fmt::format("{}: its outermost element is <{}>, wanted <sdf>", path, files.at(path).root));
  }
  const std::size_t num_models =
      std::max<std::size_t>(files.at(path).num_models, files.at(path).models_beside_world.size());
  if (num_models > 1) {
    throw base::ConfigError(fmt::format(
        "{}: has {} <model> elements at its top, wanted one; give each a file of its own", path,
        num_models));
  }
  QuickReader reader(files, notes);
  std::optional<sdf::Root> root = Load(reader.Read(path), path, notes);
  AddConsole(console, path, notes);
  return root;
}

SdfFiles ReadWorldFiles(const std::string& path, const ResourceFinder& finder, LoadNotes* notes) {
  ConsoleCapture console;
  const ConsoleBridgeCapture urdf_console;  // an included URDF is read by urdfdom
  std::string why = WhyNoWorld(base::ReadTextFile(path, XmlLimits().max_file_bytes), path);
  if (!why.empty()) throw base::ConfigError(why);
  SdfFiles files = ReadSdfFiles(path, finder, {}, notes);
  if (notes->IsFull()) notes->ThrowIfProblems(path);
  SdfFile& file = files.at(path);
  why = WhyNoWorldBy(file.root, path);
  if (!why.empty()) throw base::ConfigError(why);
  for (const std::string& place : file.models_beside_world) NoteBesideWorld("model", place, notes);
  if (std::string wrapped = AsWorld(file); !wrapped.empty()) {
    file.text = std::move(wrapped);
    file.num_worlds = 1;
    file.elements.insert("world");
    notes->Add("file", "of a static model without a world read as a world that has it", path);
  }
  if (file.num_worlds != 1) {
    throw base::ConfigError(fmt::format(
        "{}: has {} <world> elements, wanted 1{}", path, file.num_worlds,
        file.num_models > 0 ? "; a model goes with --object, or is included by a world" : ""));
  }
  return files;
}

void ReadSdfWorld(const SdfFiles& files, const std::string& path, std::size_t models_per_part,
                  LoadNotes* notes, const std::function<void(const SdfWorldPart&)>& use) {
  ConsoleCapture console;
  const ConsoleBridgeCapture urdf_console;  // libsdformat tries what it cannot read as URDF
  PartsReader reader(files, path, notes, use);
  const std::string& text = files.at(path).text;
  std::vector<WorldPart> parts = CutWorld(text, models_per_part);
  if (parts.empty()) parts.push_back({text, {}});
  for (std::size_t i = 0; i < parts.size(); ++i) {
    reader.Read(parts[i], i == 0);
    if (parts.size() > 1)
      base::ReportProgress("reading " + path, static_cast<double>(i + 1) / parts.size());
  }
  AddConsole(console, path, notes);
}

}  // namespace hires::world
