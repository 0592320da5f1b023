#include "world/sdf/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "hires/base/text.h"

namespace hires::world {
namespace {

bool Begins(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool Holds(const std::string& text, const char* what) {
  return text.find(what) != std::string::npos;
}

/// Has a line that begins so?
bool HasKey(const std::string& text, const std::string& key) {
  return Begins(text, key + ":") || text.find("\n" + key + ":") != std::string::npos;
}

std::string Is(const std::string& path, const std::string& what, const std::string& remedy) {
  return fmt::format("{}: this is {}, wanted a world (SDF); {}", path, what, remedy);
}

/// The name of the file without a template's ending.
std::string Expanded(const std::string& path, const std::string& ending) {
  const std::string name = std::filesystem::path(path).filename().string();
  const bool has_it = name.size() > ending.size() &&
                      name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  return has_it ? name.substr(0, name.size() - ending.size()) : name + ".world";
}

std::string Template(const std::string& path, const char* kind, const std::string& command,
                     const std::string& ending) {
  const std::string name = std::filesystem::path(path).filename().string();
  const std::string result = Expanded(path, ending);
  return Is(
      path, fmt::format("a template ({})", kind),
      fmt::format("run `{} {} > {}`, and give {} with --world", command, name, result, result));
}

std::string WhyNoWorldByBytes(const std::string& text, const std::string& path) {
  static const std::vector<std::string> pictures{"\x89PNG", "\xFF\xD8\xFF", "BM",   "GIF8", "II*",
                                                 "P1\n",    "P2\n",         "P3\n", "P4\n", "P5\n",
                                                 "P6\n",    "P2 ",          "P5 "};
  for (const std::string& start : pictures) {
    if (Begins(text, start))
      return Is(path, "a picture", "of a map, give the YAML file that names it with --map");
  }
  if (Begins(text, "#ROSBAG"))
    return Is(path, "a bag", "`hires map` makes a map of one, to be given with --map");
  if (Begins(text, "#VRML_SIM"))
    return Is(path, "a world of Webots",
              "write what stands in it as SDF, or give a map with --map");
  if (Begins(text, "glTF") || Begins(text, "Kaydara FBX"))
    return Is(path, "a mesh", "put it into a <static> model of a world, as its <collision>");
  return "";
}

/// Comments may tell of the template that a file was made from.
std::string WithoutComments(std::string text) {
  for (std::size_t at = text.find("<!--"); at != std::string::npos; at = text.find("<!--", at)) {
    const std::size_t end = text.find("-->", at);
    text.erase(at, end == std::string::npos ? end : end + 3 - at);
  }
  return text;
}

/// Loops and conditions of Jinja or EmPy, which no SDF has in its elements.
bool HasControl(const std::string& text) {
  const std::string plain = WithoutComments(text);
  for (const char* mark : {"{%", "@[for", "@[if", "@[while", "@[def"}) {
    if (Holds(plain, mark)) return true;
  }
  return false;
}

std::string WhyTemplate(const std::string& text, const std::string& path) {
  if (Holds(text, "{%") || Holds(text, "{{"))
    return Is(path, "a template (Jinja)", "expand it with the tool that it came with");
  if (Holds(text, "@[") || Holds(text, "@("))
    return Is(path, "a template (EmPy)", "expand it with the tool that it came with");
  return "";
}

std::string WhyNoWorldByWords(const std::string& text, const std::string& path) {
  if (Holds(text, "<%")) return Template(path, "ERB", "erb", ".erb");
  if (Holds(text, "xacro:") || Holds(text, "$(arg ")) {
    if (Holds(text, "<robot")) return Is(path, "a robot (xacro)", "give it with --robot");
    return Template(path, "xacro", "xacro", ".xacro");
  }
  return WhyTemplate(text, path);
}

std::string WhyNoWorldByKeys(const std::string& text, const std::string& path) {
  if (HasKey(text, "image") || HasKey(text, "resolution"))
    return Is(path, "a map (YAML)", "give it with --map; nodes take worlds alone");
  if (HasKey(text, "urdf")) return Is(path, "a robot's profile (YAML)", "give it with --robot");
  if (HasKey(text, "shape")) return Is(path, "an object (YAML)", "give it with --object");
  return "";
}

/// Stage writes words with values, blocks in parentheses, and comments from # on.
bool IsOfStage(const std::string& text) {
  static const std::set<std::string> words{"define",   "include",    "window", "floorplan",
                                           "position", "resolution", "model",  "interval_sim"};
  bool has_word = false, has_block = false;
  for (const std::string& line : base::Split(text, '\n')) {
    const std::string code = line.substr(0, line.find('#'));
    if (code.find_first_of("<:") != std::string::npos) return false;
    has_block = has_block || Holds(code, "(");
    const std::size_t first = code.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    const std::size_t end = std::min(code.find_first_of(" \t(\r", first), code.size());
    has_word = has_word || words.count(code.substr(first, end - first)) > 0;
  }
  return has_word && has_block;
}

std::string WhyNoWorldByEnding(const std::string& path) {
  static const std::set<std::string> meshes{".stl",  ".dae", ".obj", ".ply",  ".glb",
                                            ".gltf", ".fbx", ".off", ".blend"};
  const std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  if (meshes.count(ending) > 0)
    return Is(path, "a mesh", "put it into a <static> model of a world, as its <collision>");
  if (ending == ".yaml" || ending == ".yml")
    return Is(path, "YAML", "a map goes with --map, a robot's profile with --robot");
  if (ending == ".pgm" || ending == ".png" || ending == ".bmp")
    return Is(path, "a picture", "of a map, give the YAML file that names it with --map");
  return "";
}

}  // namespace

std::string WhyNoWorld(const std::string& text, const std::string& path) {
  std::string why = WhyNoWorldByBytes(text, path);
  if (why.empty() && Holds(text, "<sdf") && !Holds(text, "<%") && !Holds(text, "xacro:"))
    return HasControl(text) ? WhyTemplate(text, path) : "";
  if (why.empty()) why = WhyNoWorldByWords(text, path);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const bool is_xml = first != std::string::npos && text[first] == '<';
  if (why.empty() && !is_xml) why = WhyNoWorldByKeys(text, path);
  if (why.empty() && !is_xml && IsOfStage(text)) {
    why = Is(path, "a world of Stage",
             "its floorplan's bitmap is a map: write a YAML file of map_server for it, and give "
             "that with --map");
  }
  if (why.empty() && !is_xml && first != std::string::npos) why = WhyNoWorldByEnding(path);
  return why;
}

std::string WhyNoWorldBy(const std::string& root, const std::string& path) {
  static const std::map<std::string, std::pair<const char*, const char*>> kinds{
      {"robot", {"a robot (URDF)", "give it with --robot"}},
      {"COLLADA", {"a mesh", "put it into a <static> model of a world, as its <collision>"}},
      {"launch", {"a launch file", "give the world that it names"}},
      {"package", {"a package.xml", "name a world of that package"}},
      {"model", {"a model.config", "a world includes its folder by <uri>model://...</uri>"}},
      {"mujoco", {"a model for MuJoCo (MJCF)", "write its bodies as SDF"}},
      {"svg", {"a picture", "of a map, give the YAML file that names it with --map"}}};
  if (root == "sdf") return "";
  if (root == "gazebo") {
    return Is(path, "of an old format (<gazebo>, up to SDF 1.2)",
              "convert it: `gz sdf --convert FILE` of a Gazebo up to 11 writes SDF into its place");
  }
  const auto known = kinds.find(root);
  if (known != kinds.end()) return Is(path, known->second.first, known->second.second);
  return fmt::format("{}: its outermost element is <{}>, wanted <sdf> round a <world>", path, root);
}

}  // namespace hires::world
