#include "hires/perception/pcd_file.h"

#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <sstream>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"

namespace hires::perception {
namespace {

constexpr std::uint64_t kMostPoints = 50'000'000;
constexpr std::size_t kMostPointBytes = 1'000'000;
constexpr std::size_t kMostBytes = std::size_t{4} << 30;
constexpr int kMostHeaderLines = 100;

struct Field {
  std::string name;
  std::size_t size{4};    // [bytes] of one element
  char type{'F'};         // F number, I and U whole ones
  std::size_t count{1};   // elements
  std::size_t offset{0};  // [bytes] in a point; in text, elements before it
};

struct Header {
  std::vector<Field> fields{};
  std::size_t point_size{0};  // [bytes]; in text, elements
  std::uint64_t width{0}, height{0}, points{0};
  std::string data{};
};

bool IsText(const std::string& line) {
  return std::none_of(line.begin(), line.end(),
                      [](unsigned char c) { return c < 0x20 && c != '\t' && c != '\r'; });
}

/// How Windows writes what is no number, or none that is finite: 1.#QNAN, -1.#IND00, 1.#INF.
bool IsWindowsNan(const std::string& word) {
  return word.rfind("1.#", 0) == 0 || word.rfind("-1.#", 0) == 0;
}

class PcdReader {
 public:
  explicit PcdReader(const std::string& path)
      : path_(path), in_(base::ReadTextFile(path, kMostBytes)) {}
  PointCloud Read();

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw base::ConfigError(fmt::format("{}: {}", path_, what));
  }
  [[noreturn]] void FailLine(const std::string& what) const {
    Fail(fmt::format("line {}: {}", line_, what));
  }
  void ReadHeader();
  void TakeLine(const std::vector<std::string>& words);
  void TakeFields(const std::vector<std::string>& words);
  void CheckHeader();
  std::uint64_t WholeNumber(const std::string& word, std::uint64_t least, std::uint64_t most) const;
  std::array<const Field*, 3> Xyz() const;
  void WarnOfRest();
  void ReadText(PointCloud* cloud);
  void ReadBinary(PointCloud* cloud);
  void ReadCompressed(PointCloud* cloud);
  std::vector<char> ReadBytes(std::size_t size);
  float NumberAt(const char* bytes, const Field& field) const;

  std::string path_;
  std::istringstream in_;
  int line_{0};
  Header header_;
};

PointCloud PcdReader::Read() {
  ReadHeader();
  CheckHeader();
  PointCloud cloud;
  cloud.width = static_cast<int>(header_.width);
  cloud.height = static_cast<int>(header_.height);
  const std::uint64_t least = header_.data == "binary_compressed" ? 0 : header_.point_size;
  if (static_cast<std::uint64_t>(in_.rdbuf()->in_avail()) < least * header_.points) {
    Fail(fmt::format("ends {} bytes after its header, too early for {} points; is it copied whole?",
                     in_.rdbuf()->in_avail(), header_.points));
  }
  if (header_.data == "ascii") {
    ReadText(&cloud);
  } else if (header_.data == "binary") {
    ReadBinary(&cloud);
  } else {
    ReadCompressed(&cloud);
  }
  WarnOfRest();
  return cloud;
}

/// Points behind the last one that the header speaks of, as of files that were joined by hand.
void PcdReader::WarnOfRest() {
  std::uint64_t more = 0;
  if (header_.data == "ascii") {
    for (std::string text; std::getline(in_, text);) {
      more += text.find_first_not_of(" \t\r") != std::string::npos ? 1 : 0;
    }
  } else if (header_.data == "binary") {
    const std::vector<char> rest = ReadBytes(static_cast<std::size_t>(in_.rdbuf()->in_avail()));
    const bool is_padding = std::all_of(rest.begin(), rest.end(), [](char c) { return c == 0; });
    if (!is_padding) more = rest.size() / std::max<std::size_t>(header_.point_size, 1);
  }
  if (more == 0) return;
  base::Log(base::LogLevel::kWarn,
            fmt::format("{}: {} more points follow the {} that its header says: left out; correct "
                        "WIDTH, HEIGHT and POINTS if they belong to it",
                        path_, more, header_.points));
}

void PcdReader::ReadHeader() {
  std::string text;
  if (in_.peek() == std::istringstream::traits_type::eof())
    Fail("is an empty file; wanted a cloud (.pcd): copy or record it again");
  while (header_.data.empty()) {
    if (++line_ > kMostHeaderLines || !std::getline(in_, text))
      Fail("has no line DATA; wanted a header of the Point Cloud Data format (.pcd)");
    if (line_ == 1 && !IsText(text))
      Fail("is no text, wanted a header of the Point Cloud Data format (.pcd)");
    std::istringstream split(text);
    std::vector<std::string> words;
    for (std::string word; split >> word && word[0] != '#';) words.push_back(word);
    if (!words.empty()) TakeLine(words);
  }
}

void PcdReader::TakeLine(const std::vector<std::string>& words) {
  const std::string& key = words[0];
  if (line_ == 1 && key == "ply")
    Fail("is a cloud in PLY, wanted .pcd; `pcl_ply2pcd IN.ply OUT.pcd` of PCL's tools makes one");
  if (key == "FIELDS" || key == "COLUMNS") {
    for (std::size_t i = 1; i < words.size(); ++i) header_.fields.push_back({words[i]});
  } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
    TakeFields(words);
  } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
    if (words.size() != 2) FailLine(key + " wants one number");
    std::uint64_t& number = key == "WIDTH"    ? header_.width
                            : key == "HEIGHT" ? header_.height
                                              : header_.points;
    number = WholeNumber(words[1], 0, kMostPoints);
  } else if (key == "DATA") {
    header_.data = words.size() == 2 ? base::ToLower(words[1]) : "";
    if (header_.data != "ascii" && header_.data != "binary" && header_.data != "binary_compressed")
      FailLine(fmt::format("DATA is '{}'; wanted ascii, binary or binary_compressed",
                           base::Shortened(header_.data, 40)));
  } else if (key != "VERSION" && key != "VIEWPOINT") {
    FailLine(fmt::format("'{}' begins no line of a header of the Point Cloud Data format (.pcd)",
                         base::Shortened(key, 40)));
  }
}

void PcdReader::TakeFields(const std::vector<std::string>& words) {
  if (words.size() != header_.fields.size() + 1) {
    FailLine(fmt::format("{} says {} values for {} fields; wanted one for each, after FIELDS",
                         words[0], words.size() - 1, header_.fields.size()));
  }
  for (std::size_t i = 0; i < header_.fields.size(); ++i) {
    const std::string& word = words[i + 1];
    if (words[0] == "SIZE") {
      header_.fields[i].size = WholeNumber(word, 1, 8);
    } else if (words[0] == "COUNT") {
      header_.fields[i].count = WholeNumber(word, 0, 100000);
    } else {
      header_.fields[i].type = word[0] == 'f' ? 'F' : word[0];
    }
  }
}

std::uint64_t PcdReader::WholeNumber(const std::string& word, std::uint64_t least,
                                     std::uint64_t most) const {
  std::uint64_t number = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, number);
  if (error != std::errc() || rest != end || number < least || number > most)
    FailLine(fmt::format("'{}' is no whole number from {} to {}", base::Shortened(word, 40), least,
                         most));
  return number;
}

void PcdReader::CheckHeader() {
  // Files older than 0.7 say POINTS alone, some others no HEIGHT: as PCL, in one row then.
  if (header_.height == 0 && header_.points > 0) {
    header_.height = 1;
    if (header_.width == 0) header_.width = header_.points;
  }
  if (header_.points == 0) header_.points = header_.width * header_.height;
  if (header_.width * header_.height != header_.points) {
    Fail(fmt::format("WIDTH {} times HEIGHT {} are not the {} POINTS", header_.width,
                     header_.height, header_.points));
  }
  if (header_.points > kMostPoints) {
    Fail(fmt::format("WIDTH {} times HEIGHT {} are {} points; at most {} are read", header_.width,
                     header_.height, header_.points, kMostPoints));
  }
  for (Field& field : header_.fields) {
    field.offset = header_.point_size;
    header_.point_size += field.count * (header_.data == "ascii" ? 1 : field.size);
    if (header_.point_size > kMostPointBytes)
      Fail(fmt::format("a point has more than {} bytes; check COUNT", kMostPointBytes));
  }
  for (const Field* field : Xyz()) {
    if (field->type != 'F' || (field->size != 4 && field->size != 8) || field->count != 1) {
      Fail(fmt::format("field {} is of TYPE {}, SIZE {}, COUNT {}; wanted F, 4 or 8, 1",
                       field->name, field->type, field->size, field->count));
    }
  }
}

std::array<const Field*, 3> PcdReader::Xyz() const {
  std::array<const Field*, 3> found{};
  constexpr const char* kNames[] = {"x", "y", "z"};
  std::vector<std::string> names;
  for (const Field& field : header_.fields) names.push_back(field.name);
  for (int axis = 0; axis < 3; ++axis) {
    for (const Field& field : header_.fields)
      if (field.name == kNames[axis] && found[axis] == nullptr) found[axis] = &field;
    if (found[axis] == nullptr) {
      Fail(fmt::format("has no field {}; it has {}", kNames[axis],
                       names.empty() ? "none" : base::Shortened(base::Join(names, ", "))));
    }
  }
  return found;
}

void PcdReader::ReadText(PointCloud* cloud) {
  const auto xyz = Xyz();
  std::string text;
  cloud->points.resize(header_.points);
  for (std::size_t i = 0; i < cloud->points.size(); ++i) {
    std::vector<std::string> words;
    while (words.empty()) {  // lines of blanks are none
      ++line_;
      if (!std::getline(in_, text))
        Fail(fmt::format("ends after {} of {} points", i, cloud->points.size()));
      std::istringstream split(text);
      for (std::string word; split >> word;) words.push_back(word);
    }
    if (words.size() != header_.point_size) {
      FailLine(fmt::format("has {} values; wanted {}, as the fields say", words.size(),
                           header_.point_size));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::string& word = words[xyz[axis]->offset];
      char* end = nullptr;
      cloud->points[i][axis] = std::strtof(word.c_str(), &end);
      if (IsWindowsNan(word)) {
        cloud->points[i][axis] = std::numeric_limits<float>::quiet_NaN();
      } else if (*end != '\0') {
        FailLine(fmt::format("{} is '{}', no number", xyz[axis]->name, base::Shortened(word, 40)));
      }
    }
  }
}

std::vector<char> PcdReader::ReadBytes(std::size_t size) {
  const auto left = static_cast<std::size_t>(in_.rdbuf()->in_avail());
  if (left < size)
    Fail(fmt::format("ends after {} of {} bytes of its points; is it copied whole?", left, size));
  std::vector<char> bytes(size);
  in_.read(bytes.data(), static_cast<std::streamsize>(size));
  return bytes;
}

float PcdReader::NumberAt(const char* bytes, const Field& field) const {
  if (field.size == 8) {
    double number = 0.0;
    std::memcpy(&number, bytes, sizeof(number));
    return static_cast<float>(number);
  }
  float number = 0.0F;
  std::memcpy(&number, bytes, sizeof(number));
  return number;
}

void PcdReader::ReadBinary(PointCloud* cloud) {
  const auto xyz = Xyz();
  const std::vector<char> bytes = ReadBytes(header_.points * header_.point_size);
  cloud->points.resize(header_.points);
  for (std::size_t i = 0; i < cloud->points.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      cloud->points[i][axis] =
          NumberAt(&bytes[i * header_.point_size + xyz[axis]->offset], *xyz[axis]);
}

void PcdReader::ReadCompressed(PointCloud* cloud) {
  std::uint32_t sizes[2];  // compressed, whole
  const std::vector<char> head = ReadBytes(sizeof(sizes));
  std::memcpy(sizes, head.data(), sizeof(sizes));
  const std::uint64_t wanted = header_.points * header_.point_size;
  if (sizes[1] != wanted) {
    Fail(fmt::format("unpacks to {} bytes; {} points of {} bytes are {}", sizes[1], header_.points,
                     header_.point_size, wanted));
  }
  const std::vector<char> packed = ReadBytes(sizes[0]);
  std::vector<char> bytes(wanted);
  if (lzf_decompress(packed.data(), sizes[0], bytes.data(), sizes[1]) != sizes[1])
    Fail("its packed points are damaged");
  cloud->points.resize(header_.points);
  for (int axis = 0; axis < 3; ++axis) {  // field by field, each of all points
    const Field& field = *Xyz()[axis];
    const char* first = &bytes[field.offset * header_.points];
    for (std::size_t i = 0; i < cloud->points.size(); ++i)
      cloud->points[i][axis] = NumberAt(first + i * field.size, field);
  }
}

/// @param fields  lines FIELDS to COUNT.
std::string HeaderOf(const PointCloud& cloud, const char* fields) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n{}\nWIDTH {}\nHEIGHT {}\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      fields, cloud.width, cloud.height, cloud.points.size());
}

void AppendPoint(const Eigen::Vector3f& p, std::string* text) {
  text->append(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float));
}

}  // namespace

PointCloud ReadPcd(const std::string& path) { return PcdReader(path).Read(); }

void WritePcd(const PointCloud& cloud, const std::string& path) {
  std::string text = HeaderOf(cloud, "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1");
  for (const Eigen::Vector3f& p : cloud.points) AppendPoint(p, &text);
  base::ReplaceTextFile(path, text);
}

void WriteLabelledPcd(const PointCloud& cloud, const std::vector<int>& labels,
                      const std::string& path) {
  HIRES_CHECK(labels.size() == cloud.points.size(), "each point has a label");
  std::string text =
      HeaderOf(cloud, "FIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1");
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    AppendPoint(cloud.points[i], &text);
    const auto label = static_cast<std::uint32_t>(labels[i]);
    text.append(reinterpret_cast<const char*>(&label), sizeof(label));
  }
  base::ReplaceTextFile(path, text);
}

}  // namespace hires::perception
