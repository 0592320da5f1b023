#include "hires/localisation/log_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/progress.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "localisation/laser_maximum.h"
#include "localisation/laser_places.h"
#include "localisation/log_repair.h"
#include "localisation/odometry_units.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;

constexpr std::size_t kMostLogBytes = std::size_t{1} << 30;
constexpr int kMostLogLines = 20'000'000;
constexpr int kMostRanges = 100'000;         // of a scan; remissions, too
constexpr double kMostTime = 1e11;           // [s]
constexpr double kMostReadTime = 1e20;       // of any unit
constexpr double kMostCoordinate = 1e6;      // [m], [rad]
constexpr double kLatest = 1.0;              // [s] by which a line may come too late
constexpr double kCarmenMaxRange = 80.0;     // [m] what CARMEN assumes of FLASER
constexpr double kCarmenMinRange = 0.01;     // [m] its accuracy there; 0 is no measurement
constexpr double kSameSpan = 0.02;           // [rad] up to the digits that are written
constexpr double kSamePose = 1e-3;           // [m], [rad] up to the digits that are written
constexpr double kFarthestMounting = 3.0;    // [m] from the base
constexpr std::size_t kWordsOfTime = 3;      // ipc_timestamp hostname logger_timestamp
constexpr std::size_t kWordsOfOdometry = 7;  // before those
constexpr int kLinesOfForm = 1000;      // at the beginning, which show whether words are missing
constexpr double kMostOddShare = 0.01;  // of the lines that can be read
constexpr int kHopeless = 1000;         // odd lines, and none that can be read

/// Why a line cannot be read.
struct OddLine {
  std::string what;
  bool is_short{false};  // its words end too early
};

/// What a file is that is no CARMEN log, by how it begins, and what to do; empty: it may be one.
std::string OtherKindOf(std::string_view text) {
  using namespace std::string_view_literals;
  constexpr std::pair<std::string_view, const char*> kKinds[] = {
      {"\x1f\x8b"sv, "is packed: gunzip it"},
      {"BZh"sv, "is packed: bunzip2 it"},
      {"\xfd"
       "7zXZ"sv,
       "is packed: unxz it"},
      {"\x28\xb5\x2f\xfd"sv, "is packed: unzstd it"},
      {"PK\x03\x04"sv, "is packed: unzip it"},
      {"SQLite format 3"sv,
       "is a ROS 2 bag: convert it to one of ROS 1 (rosbags-convert of the package rosbags)"},
      {"\x89MCAP"sv,
       "is a ROS 2 bag: convert it to one of ROS 1 (rosbags-convert of the package rosbags)"}};
  for (const auto& [begin, what] : kKinds)
    if (text.substr(0, begin.size()) == begin) return what;
  return "";
}

/// Of a time that is too large for seconds: what it may be in, and the power of ten of that.
std::pair<const char*, int> UnitOfTime(double time) {
  if (std::abs(time) < 1e14) return {"milliseconds", 3};
  return std::abs(time) < 1e17 ? std::make_pair("microseconds", 6)
                               : std::make_pair("nanoseconds", 9);
}

/// Of a word that is no number, what it may be; else nothing.
std::string QuestionOfComma(std::string_view word) {
  return word.find(',') == std::string_view::npos
             ? ""
             : ": is that a decimal comma? Write points in the whole log (sed 's/,/./g')";
}

/// A number may begin with a plus, which std::from_chars does not take.
std::string_view WithoutPlus(std::string_view word) {
  const bool is_signed = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return is_signed ? word.substr(1) : word;
}

bool IsNumber(std::string_view word) {
  double number = 0.0;
  word = WithoutPlus(word);
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && rest == word.data() + word.size();
}

class CarmenReader {
 public:
  explicit CarmenReader(const std::string& path)
      : path_(path), text_(base::ReadTextFile(path, kMostLogBytes)) {
    base::RefuseUtf16(text_, path_);
    const std::string other = OtherKindOf(text_);
    if (!other.empty()) throw base::ConfigError(path_ + ": " + other);
    if (text_.find('\n') == std::string::npos)  // an old Mac's ends of lines
      std::replace(text_.begin(), text_.end(), '\r', '\n');
  }
  RobotLog Read();

 private:
  [[noreturn]] void Fail(const std::string& what) const { throw base::ConfigError(Where(what)); }
  std::string Where(const std::string& what) const { return path_ + ": " + InLine(what); }
  std::string InLine(const std::string& what) const {
    return fmt::format("line {}: {}", line_, what);
  }
  [[noreturn]] static void Odd(const std::string& what, bool is_short = false) {
    throw OddLine{what, is_short};
  }
  void Warn(const std::string& what) const {
    base::Log(base::LogLevel::kWarn, fmt::format("{}: {}", path_, what));
  }

  std::string_view LineAt(std::size_t begin) const {
    return std::string_view(text_).substr(begin, text_.find('\n', begin) - begin);
  }
  void SplitLine(std::string_view line);
  void FindForm();
  std::optional<std::size_t> WordsBeforeTime();
  void TakeLine(std::string_view line);
  bool Repeats(std::string_view line);
  void PassOverOdd(const OddLine& odd, std::size_t end);
  void TakeParam();
  void TakeOdometry();
  void TakeFrontLaser();
  void TakeRobotLaser();
  robot::ScanReading AngledReading(std::size_t n, std::string* doubt);
  bool TakeRawLaser();
  void TakeRawScans();
  bool RepeatsLastScan(const Pose2& pose, double time) const;
  bool IsOfTheFirstKind();
  double Angle(std::size_t index, const char* what, double most) const;
  double IncrementOf(std::size_t n, double start, double fov, double resolution,
                     std::string* doubt);
  void TakePoses(std::size_t first, RobotLog::Scan* scan);
  void AddScan(RobotLog::Scan scan, std::size_t first_of_odometry);
  void TakeUnits(std::size_t first, double time, OdometryUnits* units) const;
  void PassOver();

  void WantWords(std::size_t count, const std::string& form) const;
  double Number(std::size_t index, const char* what, double least, double most) const;
  std::size_t Count(std::size_t index, const char* what) const;
  Pose2 Pose(std::size_t index, const char* what) const;
  double Time() const;
  double InOrder(double time, double* last);
  std::vector<float> Ranges(std::size_t first, std::size_t count, double range_min) const;

  void Finish();
  void RefuseWhatIsTooOdd() const;
  void SayWhatWasPassedOver() const;
  std::string NamesPassedOver() const {
    return base::Join(std::vector<std::string>(passed_over_.begin(), passed_over_.end()), ", ");
  }
  void TakeLasersOrMount();
  void TakeOdometryOfScans();

  std::string path_, text_;
  std::vector<std::string_view> words_;  // of the line that is read
  std::size_t words_of_time_{kWordsOfTime}, words_of_odometry_{kWordsOfOdometry};
  std::string_view last_line_;
  int line_{0};
  RobotLog log_;
  LogLines lines_;
  std::string laser_kind_;             // FLASER or ROBOTLASER1, whichever came first
  std::set<std::string> passed_over_;  // kinds of lines nobody here knows
  double range_max_{kCarmenMaxRange};  // of FLASER
  double laser_offset_{0.0};           // PARAM robot_frontlaser_offset
  LaserPlaces places_;                 // of the laser on the robot
  int num_repeated_lines_{0};          // that are equal to the one before
  OdometryUnits units_, units_of_scans_;
  std::string angles_doubt_;  // what was assumed of the first scan that tells them badly
  std::map<std::string, int> other_lasers_;  // lines of kinds that are not read
  int num_repeated_{0};                      // lines ODOM with which a mapper repeats a scan's pose
  std::vector<std::pair<int, RobotLog::Scan>> raw_;  // lines RAWLASER1, while there are no others
  std::string raw_doubt_;                            // likewise of their angles
  double last_odometry_{-kMostTime}, last_scan_{-kMostTime}, last_raw_{-kMostTime};  // latest times
  int late_lines_{0};
  double latest_{0.0};           // [s] the worst of them
  int num_readable_{0};          // lines of the kinds that are read, less the odd ones
  int num_odd_{0};               // lines, without the last one where it is cut off
  std::string first_odd_, cut_;  // messages with file and line; empty: there is none
};

RobotLog CarmenReader::Read() {
  FindForm();
  const std::string task = "reading " + path_;
  for (std::size_t begin = 0; begin < text_.size();) {
    if (++line_ > kMostLogLines)
      Fail(fmt::format("is one line more than the {} that are read", kMostLogLines));
    const std::size_t end = std::min(text_.find('\n', begin), text_.size());
    const std::string_view line = std::string_view(text_).substr(begin, end - begin);
    SplitLine(line);
    try {
      if (!words_.empty()) TakeLine(line);
    } catch (const OddLine& odd) {
      PassOverOdd(odd, end);
    }
    begin = end + 1;
    if (line_ % 1000 == 0) base::ReportProgress(task, static_cast<double>(end) / text_.size());
  }
  base::ReportProgress(task, 1.0);
  Finish();
  return std::move(log_);
}

void CarmenReader::SplitLine(std::string_view line) {
  constexpr std::string_view kWhite = " \t\r";
  words_.clear();
  for (std::size_t begin = line.find_first_not_of(kWhite); begin != std::string_view::npos;) {
    if (words_.empty() && line[begin] == '#') return;
    const std::size_t end = std::min(line.find_first_of(kWhite, begin), line.size());
    words_.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kWhite, end);
  }
}

/// Of a line that is read, if it begins well; of ODOM as it should be.
std::optional<std::size_t> CarmenReader::WordsBeforeTime() {
  try {
    if (words_[0] == "ODOM") return kWordsOfOdometry;
    if (words_[0] == "FLASER") return 8 + Count(1, "number of ranges");
    const bool is_robot = words_[0] == "ROBOTLASER1";
    if (!is_robot && words_[0] != "RAWLASER1") return std::nullopt;
    const std::size_t n = Count(8, "number of ranges");
    return (is_robot ? 21 : 10) + n + Count(9 + n, "number of remissions");
  } catch (const OddLine&) {
    return std::nullopt;
  }
}

/// Some loggers write no times, or no acceleration in lines ODOM. It takes two lines to show it:
/// one may be cut off.
void CarmenReader::FindForm() {
  int num_told = 0, num_timeless = 0, num_odometry = 0, num_short = 0;
  std::size_t begin = 0;
  for (int i = 0; i < kLinesOfForm && begin < text_.size(); ++i) {
    const std::string_view line = LineAt(begin);
    begin += line.size() + 1;
    SplitLine(line);
    const std::optional<std::size_t> count = words_.empty() ? std::nullopt : WordsBeforeTime();
    if (!count) continue;
    const std::size_t size = words_.size();
    const bool is_odometry = words_[0] == "ODOM";
    const bool has_host = size + 1 == *count + kWordsOfTime && !IsNumber(words_[size - 2]);
    const bool is_short = is_odometry && (size + 1 == *count || has_host);
    ++num_told;
    num_timeless += size == *count || (is_odometry && size + 1 == *count) ? 1 : 0;
    num_odometry += is_odometry ? 1 : 0;
    num_short += is_short ? 1 : 0;
  }
  const auto are_nearly_all = [](int count, int all) {
    return all > 1 && all - count <= kMostOddShare * all;
  };
  if (are_nearly_all(num_timeless, num_told)) {
    words_of_time_ = 0;
    Warn("its lines have no times (ipc_timestamp hostname logger_timestamp)");
  }
  if (are_nearly_all(num_short, num_odometry)) words_of_odometry_ = kWordsOfOdometry - 1;
}

void CarmenReader::TakeLine(std::string_view line) {
  if (Repeats(line)) return;
  if (words_[0] == "ODOM") {
    TakeOdometry();
  } else if (words_[0] == "FLASER") {
    if (IsOfTheFirstKind()) TakeFrontLaser();
  } else if (words_[0] == "ROBOTLASER1") {
    if (IsOfTheFirstKind()) TakeRobotLaser();
  } else if (words_[0] == "PARAM") {
    return TakeParam();
  } else if (words_[0] != "RAWLASER1" || !TakeRawLaser()) {
    return PassOver();
  }
  ++num_readable_;
}

/// Loggers that hear a message twice write its line twice, with its time.
bool CarmenReader::Repeats(std::string_view line) {
  if (line != last_line_) {
    last_line_ = line;
    return false;
  }
  const bool is_reading =
      words_[0] == "ODOM" || words_[0] == "FLASER" || words_[0] == "ROBOTLASER1";
  if (is_reading) ++num_repeated_lines_;
  return is_reading;
}

/// @param end  of the line in the text.
void CarmenReader::PassOverOdd(const OddLine& odd, std::size_t end) {
  const bool is_last = text_.find_first_not_of(" \t\r\n", end) == std::string::npos;
  if (is_last && (end == text_.size() || odd.is_short)) {
    cut_ = Where(odd.what);
    return;
  }
  if (num_odd_++ == 0) first_odd_ = Where(odd.what);
  if (num_odd_ == kHopeless && num_readable_ == 0) throw base::ConfigError(first_odd_);
}

void CarmenReader::PassOver() {
  const std::string name(words_[0]);
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; }))
    Odd("is no text; wanted a CARMEN log: is the file still packed?");
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  const bool is_name = std::all_of(name.begin(), name.end(), [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
  if (!is_name || name.size() > 40 || !is_letter(name[0])) {
    Odd(
        fmt::format("'{}' begins no line of a CARMEN log; wanted ODOM, FLASER, ROBOTLASER1, PARAM "
                    "or the name of another message",
                    base::Shortened(name, 40)));
  }
  const bool is_laser =
      name == "RLASER" || name.rfind("ROBOTLASER", 0) == 0 || name.rfind("RAWLASER", 0) == 0;
  if (is_laser) ++other_lasers_[name];
  if (name == "SYNC" || name == "RLASER") return;
  if (passed_over_.size() < 100) passed_over_.insert(name);
}

/// Only these two matter; a log has dozens of parameters, of any form. All scans rest on them.
void CarmenReader::TakeParam() {
  if (words_.size() < 3) return;
  try {
    if (words_[1] == "robot_frontlaser_offset") {
      laser_offset_ = Number(2, "robot_frontlaser_offset", -kFarthestMounting, kFarthestMounting);
    } else if (words_[1] == "robot_front_laser_max") {
      range_max_ = Number(2, "robot_front_laser_max", kCarmenMinRange, 1e4);
    }
  } catch (const OddLine& odd) {
    Fail(odd.what);
  }
}

void CarmenReader::TakeOdometry() {
  WantWords(words_of_odometry_, words_of_odometry_ == kWordsOfOdometry
                                    ? "ODOM x y theta tv rv accel"
                                    : "ODOM x y theta tv rv");
  RobotLog::Odometry odometry;
  odometry.reading.X_OB = Pose(1, "odometry");
  odometry.reading.V_B.vx = Number(4, "tv", -kMostCoordinate, kMostCoordinate);
  odometry.reading.V_B.wz = Number(5, "rv", -kMostCoordinate, kMostCoordinate);
  const double time = Time();
  if (RepeatsLastScan(odometry.reading.X_OB, time)) {
    ++num_repeated_;
    return;
  }
  odometry.time = InOrder(time, &last_odometry_);
  TakeUnits(1, time, &units_);
  log_.odometry.push_back(odometry);
  lines_.odometry.push_back(line_);
}

/// Mappers write the pose that they found behind each scan, as odometry of no time.
bool CarmenReader::RepeatsLastScan(const Pose2& pose, double time) const {
  if (time != 0.0 || log_.scans.empty() || log_.scans.back().time == 0.0) return false;
  const RobotLog::Scan& last = log_.scans.back();
  const auto is_equal = [&](const Pose2& other) {
    return (other.position() - pose.position()).norm() <= kSamePose &&
           std::abs(geometry::WrapToPi(other.yaw - pose.yaw)) <= kSamePose;
  };
  return is_equal(*last.X_OB) || is_equal(*last.X_OB * last.X_BL);
}

bool CarmenReader::IsOfTheFirstKind() {
  if (laser_kind_.empty() || laser_kind_ == words_[0]) return true;
  passed_over_.insert(std::string(words_[0]));
  return false;
}

void CarmenReader::TakeFrontLaser() {
  const std::size_t n = Count(1, "number of ranges");
  WantWords(8 + n, "FLASER n, n ranges, x y theta of laser and odometry");
  RobotLog::Scan scan;
  scan.reading.angle_min = -geometry::kPi / 2.0;
  scan.reading.angle_increment = n < 2 ? 0.0 : geometry::kPi / static_cast<double>(n - n % 2);
  scan.reading.range_min = kCarmenMinRange;
  // Lasers of 180 degrees have steps of 1, 0.5 or 0.25, or few of several degrees.
  scan.is_field_assumed = n > 2 && 720 % (n - n % 2) != 0;
  if (angles_doubt_.empty() && scan.is_field_assumed) {
    angles_doubt_ = InLine(fmt::format(
        "FLASER of {} ranges says no angles; taken are steps of 180 degrees / {} from -90 degrees "
        "on. If the laser sees another angle, write lines ROBOTLASER1, which say theirs",
        n, n - n % 2));
  }
  scan.reading.range_max = range_max_;
  scan.reading.ranges = Ranges(2, n, kCarmenMinRange);
  TakePoses(2 + n, &scan);
  AddScan(std::move(scan), 5 + n);
}

void CarmenReader::TakeRobotLaser() {
  const std::size_t n = Count(8, "number of ranges");
  const std::size_t m = Count(9 + n, "number of remissions");
  WantWords(21 + n + m,
            "ROBOTLASER1 type start_angle fov resolution max_range accuracy mode, n, n ranges, m, "
            "m remissions, x y theta of laser and robot, tv rv forward side turn_axis");
  RobotLog::Scan scan;
  scan.reading = AngledReading(n, &angles_doubt_);
  TakePoses(10 + n + m, &scan);
  AddScan(std::move(scan), 13 + n + m);
}

/// Of ROBOTLASER1 and RAWLASER1, which begin alike.
robot::ScanReading CarmenReader::AngledReading(std::size_t n, std::string* doubt) {
  robot::ScanReading reading;
  reading.angle_min = Angle(2, "start_angle", 2.0 * geometry::kPi);
  reading.angle_increment =
      IncrementOf(n, reading.angle_min, Number(3, "fov", -kMostCoordinate, kMostCoordinate),
                  Angle(4, "angular resolution", geometry::kPi), doubt);
  reading.range_min = kCarmenMinRange;
  reading.range_max = Number(5, "max_range", 0.0, 1e6);
  reading.ranges = Ranges(9, n, kCarmenMinRange);
  return reading;
}

/// Many logs have the same scans again with poses: these are for logs that have no others.
/// @return whether the line may be needed and can be read.
bool CarmenReader::TakeRawLaser() {
  if (!laser_kind_.empty()) return false;
  try {
    const std::size_t n = Count(8, "number of ranges");
    const std::size_t m = Count(9 + n, "number of remissions");
    WantWords(10 + n + m,
              "RAWLASER1 type start_angle fov resolution max_range accuracy mode, n, n ranges, m, "
              "m remissions");
    RobotLog::Scan scan;
    scan.reading = AngledReading(n, &raw_doubt_);
    scan.time = Time();
    if (last_raw_ - scan.time > kLatest) return false;
    last_raw_ = std::max(last_raw_, scan.time);
    raw_.emplace_back(line_, std::move(scan));
  } catch (const OddLine&) {
    return false;  // passed over, as lines of other lasers are
  }
  return true;
}

/// [rad] from -most to most.
double CarmenReader::Angle(std::size_t index, const char* what, double most) const {
  const double angle = Number(index, what, -kMostCoordinate, kMostCoordinate);
  if (std::abs(angle) <= most) return angle;
  Odd(
      fmt::format("{} is '{}'; wanted radians, a number from {:.6g} to {:.6g}: are the angles in "
                  "degrees? Multiply them by 0.0174533",
                  what, std::string(words_[index]), -most, most));
}

/// By `resolution`, as CARMEN takes it, if `fov` does not say something else that goes better with
/// the first beam, as of a laser that looks as far to the left as to the right.
double CarmenReader::IncrementOf(std::size_t n, double start, double fov, double resolution,
                                 std::string* doubt) {
  if (n < 2) return resolution;
  if (std::abs(fov) > 2.0 * geometry::kPi + kSameSpan) fov = 0.0;  // degrees, or anything
  const double steps = static_cast<double>(n - 1), by_fov = fov / steps;
  if (resolution == 0.0 && fov == 0.0)
    Odd("angular resolution and fov are 0; wanted the angle between two beams [rad]");
  // Some count a step for the last beam, too.
  const double span = resolution * steps, off = std::abs(std::abs(span) - std::abs(fov));
  if (resolution != 0.0 && (fov == 0.0 || off < 1.5 * std::abs(resolution) + kSameSpan))
    return resolution;
  const bool is_by_fov =
      resolution == 0.0 || std::abs(start + fov / 2.0) < std::abs(start + span / 2.0);
  if (doubt->empty()) {
    *doubt = InLine(fmt::format(
        "{} of {} ranges says a resolution of {:.6g} rad, {:.6g} rad in all, and a fov of "
        "{:.6g} rad; taken is the {}, as the first beam is at {:.6g} rad",
        words_[0], n, resolution, span, fov, is_by_fov ? "fov" : "resolution", start));
  }
  return is_by_fov ? by_fov : resolution;
}

/// Of laser and odometry, one behind the other.
void CarmenReader::TakePoses(std::size_t first, RobotLog::Scan* scan) {
  const Pose2 X_OL = Pose(first, "pose of the laser");
  scan->X_OB = Pose(first + 3, "odometry");
  scan->X_BL = scan->X_OB->Inverse() * X_OL;
}

/// @param first_of_odometry  word
void CarmenReader::AddScan(RobotLog::Scan scan, std::size_t first_of_odometry) {
  scan.time = InOrder(Time(), &last_scan_);
  TakeUnits(first_of_odometry, scan.time, &units_of_scans_);
  laser_kind_ = words_[0];
  raw_.clear();
  places_.Take(scan.X_BL);
  log_.scans.push_back(std::move(scan));
  lines_.scans.push_back(line_);
}

/// Of the pose as the line has it, whose angle is not wrapped.
void CarmenReader::TakeUnits(std::size_t first, double time, OdometryUnits* units) const {
  const auto number = [&](std::size_t i) {
    return Number(first + i, "pose", -kMostCoordinate, kMostCoordinate);
  };
  units->Take(number(0), number(1), number(2), time);
}

/// @param count  of the words before those of the time.
void CarmenReader::WantWords(std::size_t count, const std::string& form) const {
  const std::size_t wanted = count + words_of_time_;
  if (words_.size() == wanted) return;
  Odd(fmt::format("{} has {} words; wanted {}: {}{}", words_[0], words_.size(), wanted, form,
                  words_of_time_ > 0 ? ", ipc_timestamp hostname logger_timestamp" : ""),
      words_.size() < wanted);
}

double CarmenReader::Number(std::size_t index, const char* what, double least, double most) const {
  const std::string_view word = WithoutPlus(words_[index]);
  double number = 0.0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_number = error == std::errc() && rest == word.data() + word.size();
  if (!is_number || !(number >= least && number <= most)) {
    Odd(fmt::format("{} is '{}'; wanted a number from {} to {}{}", what,
                    base::Shortened(std::string(words_[index]), 40), least, most,
                    QuestionOfComma(word)));
  }
  return number;
}

std::size_t CarmenReader::Count(std::size_t index, const char* what) const {
  if (index >= words_.size()) Odd(fmt::format("{} ends before its {}", words_[0], what), true);
  const std::string_view word = WithoutPlus(words_[index]);
  std::size_t number = 0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || rest != word.data() + word.size() || number > kMostRanges) {
    Odd(fmt::format("{} is '{}'; wanted a whole number from 0 to {}", what,
                    base::Shortened(std::string(word), 40), kMostRanges));
  }
  return number;
}

Pose2 CarmenReader::Pose(std::size_t index, const char* what) const {
  const auto coordinate = [&](std::size_t i, const char* name) {
    return Number(i, fmt::format("{} of the {}", name, what).c_str(), -kMostCoordinate,
                  kMostCoordinate);
  };
  return {coordinate(index, "x"), coordinate(index + 1, "y"),
          geometry::WrapToPi(coordinate(index + 2, "theta"))};
}

/// Of the readings; the last three words say it, if there are any.
double CarmenReader::Time() const {
  if (words_of_time_ == 0) return 0.0;
  const auto time = [&](std::size_t index, const char* what) {
    const double number = Number(index, what, -kMostReadTime, kMostReadTime);
    if (std::abs(number) <= kMostTime) return number;
    const auto [unit, power] = UnitOfTime(number);
    Odd(fmt::format("{} is {:.0f}; wanted seconds: is it in {}? Divide it by 1e{}", what, number,
                    unit, power));
  };
  time(words_.size() - 1, "logger_timestamp");
  return time(words_.size() - 3, "ipc_timestamp");
}

double CarmenReader::InOrder(double time, double* last) {
  const double late = *last - time;
  if (late > kLatest) {
    Odd(
        fmt::format("ipc_timestamp {:.6f} is {:.3f} s before that of an earlier {}; wanted times "
                    "that grow: if the log is of several drives, cut it here",
                    time, late, words_[0]));
  }
  if (late > 0.0) {
    ++late_lines_;
    latest_ = std::max(latest_, late);
  }
  *last = std::max(*last, time);
  return time;
}

std::vector<float> CarmenReader::Ranges(std::size_t first, std::size_t count,
                                        double range_min) const {
  constexpr float kInvalid = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> ranges(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view word = WithoutPlus(words_[first + i]);
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), ranges[i]);
    if (error == std::errc::result_out_of_range) {
      ranges[i] = kInvalid;  // 1e-60, 1e60
    } else if (error != std::errc() || rest != word.data() + word.size()) {
      Odd(fmt::format("range {} is '{}'; wanted a number [m]{}", i + 1,
                      base::Shortened(std::string(word), 40), QuestionOfComma(word)));
    }
    if (!(ranges[i] >= range_min)) ranges[i] = kInvalid;
  }
  return ranges;
}

void CarmenReader::Finish() {
  RefuseWhatIsTooOdd();
  if (log_.scans.empty() && !raw_.empty()) TakeRawScans();
  if (num_repeated_ > 0) {
    Warn(
        fmt::format("{} lines ODOM of time 0 repeat the pose of the scan before them, as where a "
                    "mapper has corrected the log: passed over",
                    num_repeated_));
  }
  const std::string spread = SpreadEqualTimes(lines_, &log_);
  if (!spread.empty()) Warn(spread);
  if (late_lines_ > 0) {
    Warn(fmt::format("{} lines are older than one before them, by up to {:.3f} s; put in order",
                     late_lines_, latest_));
  }
  const auto earlier = [](const auto& a, const auto& b) { return a.time < b.time; };
  std::stable_sort(log_.odometry.begin(), log_.odometry.end(), earlier);
  std::stable_sort(log_.scans.begin(), log_.scans.end(), earlier);
  const std::string contradicting = LeaveOutContradicting(&log_);
  if (!contradicting.empty()) Warn(contradicting);
  if (places_.do_vary()) TakeLasersOrMount();
  const bool has_odometry = !log_.odometry.empty();
  if (!has_odometry) TakeOdometryOfScans();
  const std::string maximum = TakeLaserMaximum(&log_);
  if (!maximum.empty()) {
    Warn(maximum +
         "; a line PARAM robot_front_laser_max or the max_range of ROBOTLASER1 may say otherwise");
  }
  for (const std::string& what : {angles_doubt_, (has_odometry ? units_ : units_of_scans_).Doubt()})
    if (!what.empty()) Warn(what);
  SayWhatWasPassedOver();
}

void CarmenReader::RefuseWhatIsTooOdd() const {
  if (num_odd_ > kMostOddShare * (num_readable_ + num_odd_)) {
    if (num_odd_ == 1) throw base::ConfigError(first_odd_);
    throw base::ConfigError(
        fmt::format("{}; {} more lines cannot be read, beside {} that can: passed over are {:g} % "
                    "at most",
                    first_odd_, num_odd_ - 1, num_readable_, 100.0 * kMostOddShare));
  }
  if (!log_.scans.empty() || !log_.odometry.empty()) return;
  if (!raw_.empty()) {
    throw base::ConfigError(fmt::format(
        "{}: has {} lines RAWLASER1, which tell no poses, and no line ODOM; wanted odometry", path_,
        raw_.size()));
  }
  if (!cut_.empty()) throw base::ConfigError(cut_);
  throw base::ConfigError(
      fmt::format("{}: has no line FLASER, ROBOTLASER1 or ODOM{}; wanted a CARMEN log", path_,
                  passed_over_.empty() ? "" : fmt::format(", but {}", NamesPassedOver())));
}

/// Where the robot was, lines ODOM tell; where its laser sits, a parameter.
void CarmenReader::TakeRawScans() {
  const int num_odd = other_lasers_["RAWLASER1"];
  Warn(
      fmt::format("{} lines RAWLASER1 tell no poses: odometry is interpolated between lines ODOM, "
                  "and the laser is taken {} m before the base (PARAM robot_frontlaser_offset){}",
                  raw_.size(), laser_offset_,
                  num_odd > 0 ? fmt::format("; {} more cannot be read", num_odd) : ""));
  for (auto& [line, scan] : raw_) {
    scan.X_BL = {laser_offset_, 0.0, 0.0};
    log_.scans.push_back(std::move(scan));
    lines_.scans.push_back(line);
  }
  angles_doubt_ = raw_doubt_;
}

void CarmenReader::TakeLasersOrMount() {
  const std::string lasers = places_.TextOfLasers();
  if (!lasers.empty()) {
    return Warn(
        fmt::format("lines {} are of several lasers, by their places (x y yaw) on the "
                    "robot, and all are taken: {}",
                    laser_kind_, lasers));
  }
  Warn(
      fmt::format("the laser's place on the robot is not the same in all lines, as where a mapper "
                  "has corrected the log; taken is {} m before the base (PARAM "
                  "robot_frontlaser_offset)",
                  laser_offset_));
  for (RobotLog::Scan& scan : log_.scans) scan.X_BL = {laser_offset_, 0.0, 0.0};
}

void CarmenReader::TakeOdometryOfScans() {
  for (const RobotLog::Scan& scan : log_.scans) {
    RobotLog::Odometry odometry{scan.time, {*scan.X_OB, {}}};
    if (!log_.odometry.empty()) {
      const RobotLog::Odometry& last = log_.odometry.back();
      const double passed = scan.time - last.time;
      const Pose2 step = last.reading.X_OB.Inverse() * *scan.X_OB;
      odometry.reading.V_B = passed > 0.0 ? geometry::Twist2{step.x / passed, step.y / passed,
                                                             geometry::WrapToPi(step.yaw) / passed}
                                          : last.reading.V_B;
    }
    log_.odometry.push_back(odometry);
  }
}

void CarmenReader::SayWhatWasPassedOver() const {
  if (num_odd_ > 0) {
    base::Log(base::LogLevel::kWarn,
              fmt::format("{}; passed over, like {} more lines", first_odd_, num_odd_ - 1));
  }
  if (!cut_.empty())
    base::Log(base::LogLevel::kWarn, cut_ + "; the log's last line, which is cut off: passed over");
  if (num_repeated_lines_ > 0) {
    Warn(fmt::format("{} lines are equal to the one before, with its time: passed over",
                     num_repeated_lines_));
  }
  if (log_.scans.empty() && !other_lasers_.empty()) {
    std::vector<std::string> kinds;
    for (const auto& [name, count] : other_lasers_)
      kinds.push_back(fmt::format("{} {}", count, name));
    Warn(
        fmt::format("lines of other lasers are not read: {}; FLASER and ROBOTLASER1 are: rename "
                    "those of the laser that is meant, if they have the same form",
                    base::Join(kinds, ", ")));
  }
  if (passed_over_.empty()) return;
  base::Log(base::LogLevel::kInfo,
            fmt::format("{}: passed over lines of {}", path_, NamesPassedOver()));
}

std::string Words(const Pose2& pose) {
  return fmt::format(" {:.6f} {:.6f} {:.6f}", pose.x, pose.y, pose.yaw);
}

}  // namespace

RobotLog ReadCarmenLog(const std::string& path) { return CarmenReader(path).Read(); }

void WriteCarmenLog(const RobotLog& log, const std::string& file) {
  std::string text = "# CARMEN log\n";
  const auto end_line = [&](double time) {
    text += fmt::format(" {:.6f} nohost {:.6f}\n", time, time);
  };
  auto odometry = log.odometry.begin();
  const auto write_odometry_until = [&](double time) {
    for (; odometry != log.odometry.end() && odometry->time <= time; ++odometry) {
      text += "ODOM" + Words(odometry->reading.X_OB);
      text += fmt::format(" {:.6f} {:.6f} 0", odometry->reading.V_B.vx, odometry->reading.V_B.wz);
      end_line(odometry->time);
    }
  };
  for (const RobotLog::Scan& scan : log.scans) {
    HIRES_CHECK(scan.X_OB && scan.reading.range_max > 0.0, "scans have odometry and a range_max");
    write_odometry_until(scan.time);
    const robot::ScanReading& reading = scan.reading;
    const std::size_t n = reading.ranges.size();
    text += fmt::format("ROBOTLASER1 0 {:.9f} {:.9f} {:.9f} {} {} 0 {}", reading.angle_min,
                        reading.angle_increment * static_cast<double>(n > 0 ? n - 1 : 0),
                        reading.angle_increment, reading.range_max, kCarmenMinRange, n);
    for (const float range : reading.ranges) {
      const bool is_number = range >= reading.range_min;
      text += is_number ? fmt::format(" {:.4f}", std::min<double>(range, reading.range_max)) : " 0";
    }
    text += " 0" + Words(*scan.X_OB * scan.X_BL) + Words(*scan.X_OB) + " 0 0 0 0 0";
    end_line(scan.time);
  }
  write_odometry_until(std::numeric_limits<double>::infinity());
  base::ReplaceTextFile(file, text);
}

void WriteTumTrajectory(const TimedPath& path, const std::string& file) {
  std::string text;
  for (const TimedPose& pose : path) {
    HIRES_CHECK(std::isfinite(pose.time) && pose.X_MB.IsFinite(), "a trajectory is of numbers");
    const double half = pose.X_MB.yaw / 2.0;
    text += fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", pose.time, pose.X_MB.x,
                        pose.X_MB.y, std::sin(half), std::cos(half));
  }
  base::ReplaceTextFile(file, text);
}

}  // namespace hires::localisation
