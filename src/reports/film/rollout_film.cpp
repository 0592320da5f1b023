#include "reports/film/rollout_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <future>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/perception/picture_scene.h"
#include "hires/robot/posture.h"
#include "reports/film/film_cameras.h"
#include "reports/film/film_colours.h"
#include "reports/film/picture_files.h"
#include "reports/film/picture_text.h"

namespace hires::reports {
namespace {

using imagination::RolloutEvent;
using imagination::RolloutRecording;
using imagination::RolloutSample;
using perception::Colour;
using perception::PaintedBody;
using perception::Picture;

constexpr double kGlassHeight = 1.7;  // [m]
constexpr double kEventShown = 1.5;   // [s]
constexpr double kTraceStep = 0.08;   // [m]
constexpr double kLastFrame = 2.0;    // [s]
constexpr int kGap = 4;               // [pixels] between pictures
constexpr int kMargin = 6;            // [pixels] left of text
constexpr int kEventColumn = 290;     // [pixels] right of the longest numbers

PaintedBody Plate(const geometry::Pose3& X_MB, const Eigen::Vector3d& size, const Colour& colour) {
  PaintedBody body;
  body.shapes_B.emplace_back();
  body.shapes_B.back().shape = geometry::Box{size};
  body.X_MB = X_MB;
  body.colour = colour;
  return body;
}

PaintedBody BodyOf(const simulation::Scene& scene, const std::string& model,
                   const geometry::Pose3& X_MO, const Colour& colour) {
  return {scene.world.RequireModel(model)->collisions, X_MO, colour, false};
}

/// Furniture, walls, and where the action leads.
std::vector<PaintedBody> FixedBodies(const simulation::Scene& scene,
                                     const RolloutRecording& recording) {
  std::vector<PaintedBody> bodies;
  for (const world::StaticBody& body : scene.world.statics) {
    geometry::Aabb bounds;
    for (const geometry::Collision& part : body.collisions) {
      bounds.Include(geometry::BoundsOf(part.shape, body.X_MB * part.X_BS));
    }
    const bool is_wall = bounds.upper.z() > kGlassHeight;
    bodies.push_back({body.collisions, body.X_MB, is_wall ? kWall : kFurniture, is_wall});
  }
  for (const std::string& argument : recording.action.arguments) {
    const auto X_MF = scene.world.FindFrame(argument);
    if (X_MF) bodies.push_back(Plate(*X_MF, {0.5, 0.5, 0.006}, kGoal));
  }
  return bodies;
}

/// What is left out of physics because nothing comes near it stands where it stood.
std::vector<PaintedBody> Bystanders(const imagination::RolloutSetup& setup,
                                    const RolloutRecording& recording) {
  std::vector<PaintedBody> bodies;
  for (const world::ObjectState& object : setup.world_state.objects) {
    if (std::count(recording.objects.begin(), recording.objects.end(), object.name) > 0) continue;
    bodies.push_back(BodyOf(*setup.scene, object.model, object.X_MO, kOther));
  }
  return bodies;
}

/// Calls `draw` with 0 .. count - 1 in so many threads.
void InParallel(int count, int threads, const std::function<void(int)>& draw) {
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) draw(i);
  };
  std::vector<std::future<void>> others;
  for (int k = 1; k < threads; ++k) others.push_back(std::async(std::launch::async, work));
  work();
  for (std::future<void>& other : others) other.get();
}

void Paste(const Picture& part, int column, int row, Picture* whole) {
  for (int y = 0; y < part.height; ++y) {
    std::copy_n(&part.At(0, y), part.width, &whole->At(column, row + y));
  }
}

}  // namespace

struct RolloutFilm::Impl {
  Impl(const imagination::RolloutSetup& setup, const RolloutRecording& recording_in,
       const FilmParams& params_in)
      : params(params_in),
        recording(recording_in),
        scene(setup.scene),
        load(LoadOf(recording, scene->X_BO)),
        close(CloseCameras(recording, load, scene->X_BO, params.view_width, params.view_height)),
        overview(OverviewCamera(recording, params.view_width, params.view_height)),
        fixed(FixedBodies(*scene, recording)) {
    for (const PaintedBody& body : Bystanders(setup, recording)) fixed.push_back(body);
    for (const std::string& name : recording.objects) {
      models.push_back(setup.world_state.Find(name)->model);
    }
    pictures = std::make_unique<perception::PictureScene>(fixed, MovingAt(0));
  }

  std::vector<PaintedBody> MovingAt(int sample) const;
  void AddTrace(int sample, std::vector<PaintedBody>* bodies) const;
  Picture Draw(const perception::PinholeCamera& camera, int sample) const {
    return pictures->Draw(camera, MovingAt(sample));
  }
  double TiltAt(int sample) const;
  const RolloutEvent* EventAt(int sample) const;
  std::string Title() const;
  std::string NumbersAt(int sample) const;
  void WriteEvent(int sample, int column, int row, Picture* frame) const;

  const FilmParams params;
  const RolloutRecording& recording;
  std::shared_ptr<const simulation::Scene> scene;
  std::optional<int> load;
  std::vector<perception::PinholeCamera> close;  // of each sample
  perception::PinholeCamera overview;
  std::vector<PaintedBody> fixed;
  std::vector<std::string> models;  // of each object
  std::unique_ptr<perception::PictureScene> pictures;
};

std::vector<PaintedBody> RolloutFilm::Impl::MovingAt(int sample) const {
  const RolloutSample& now = recording.samples[sample];
  std::vector<PaintedBody> bodies(2);
  bodies[0].colour = kRobot;
  bodies[1].colour = kTray;
  bodies[0].X_MB = bodies[1].X_MB = now.X_MB;
  const std::string& tray = scene->robot.profile.tray_link;
  for (geometry::Collision& part :
       simulation::FrozenShapes(scene->robot, robot::PostureOf(scene->robot, now.joints))) {
    const bool is_tray = !tray.empty() && part.name.substr(0, part.name.find('/')) == tray;
    bodies[is_tray ? 1 : 0].shapes_B.push_back(std::move(part));
  }
  for (std::size_t i = 0; i < models.size(); ++i) {
    const bool is_load = load && *load == static_cast<int>(i);
    bodies.push_back(BodyOf(*scene, models[i], now.X_MO[i], is_load ? kLoad : kOther));
  }
  AddTrace(sample, &bodies);
  return bodies;
}

/// The way of the base so far, as a line on the floor.
void RolloutFilm::Impl::AddTrace(int sample, std::vector<PaintedBody>* bodies) const {
  Eigen::Vector2d from = recording.samples[0].X_MB.translation.head<2>();
  for (int i = 1; i <= sample; ++i) {
    const Eigen::Vector2d to = recording.samples[i].X_MB.translation.head<2>(), way = to - from;
    if (way.norm() < kTraceStep) continue;
    const Eigen::Vector2d middle = 0.5 * (from + to);
    const geometry::Pose2 X_MP{middle.x(), middle.y(), std::atan2(way.y(), way.x())};
    bodies->push_back(Plate(geometry::Lift(X_MP), {way.norm() + 0.02, 0.05, 0.01}, kTrace));
    from = to;
  }
}

double RolloutFilm::Impl::TiltAt(int sample) const {
  return load ? geometry::TiltOf(recording.samples[sample].X_MO[*load].rotation) : 0.0;
}

/// What happened last, for a while; the end stays.
const RolloutEvent* RolloutFilm::Impl::EventAt(int sample) const {
  const double now = recording.samples[sample].time;
  const RolloutEvent* last = nullptr;
  for (const RolloutEvent& event : recording.events) {
    if (event.time > now) break;
    if (event.kind == RolloutEvent::Kind::kEnd || now - event.time < kEventShown) last = &event;
  }
  return last;
}

std::string RolloutFilm::Impl::Title() const {
  return fmt::format("{}   rollout {}", ToString(recording.action), recording.index);
}

std::string RolloutFilm::Impl::NumbersAt(int sample) const {
  const RolloutSample& now = recording.samples[sample];
  const std::string numbers =
      fmt::format("{:5.2f} s   {:.2f} m/s", now.time, std::hypot(now.V_B.vx, now.V_B.vy));
  return load ? numbers + fmt::format("   tilt {:.3f} rad", TiltAt(sample)) : numbers;
}

void RolloutFilm::Impl::WriteEvent(int sample, int column, int row, Picture* frame) const {
  const RolloutEvent* event = EventAt(sample);
  if (event == nullptr) return;
  const bool is_end = event->kind == RolloutEvent::Kind::kEnd;
  const bool is_well = is_end && !imagination::FailureOf(recording.result);
  const bool is_bad = (is_end && !is_well) || event->kind == RolloutEvent::Kind::kFalls ||
                      event->kind == RolloutEvent::Kind::kContact;
  WriteLine(event->text, column, row, frame->width - 4,
            is_bad    ? kAlarm
            : is_well ? kWell
                      : kInk,
            frame);
}

RolloutFilm::RolloutFilm(const imagination::RolloutSetup& setup, const RolloutRecording& recording,
                         const FilmParams& params) {
  if (recording.samples.empty()) {
    throw base::ConfigError(
        fmt::format("rollout {} of {} ended before there was anything to see ({}); choose another",
                    recording.index, ToString(recording.action),
                    ToString(imagination::FailureOf(recording.result))));
  }
  impl_ = std::make_unique<Impl>(setup, recording, params);
}

RolloutFilm::~RolloutFilm() = default;

int RolloutFilm::num_samples() const { return static_cast<int>(impl_->recording.samples.size()); }
const FilmParams& RolloutFilm::params() const { return impl_->params; }
const RolloutRecording& RolloutFilm::recording() const { return impl_->recording; }

Picture RolloutFilm::FrameAt(int sample) const {
  HIRES_CHECK(sample >= 0 && sample < num_samples(), "a sample of the recording");
  const int width = impl_->params.view_width, height = impl_->params.view_height;
  Picture frame(2 * width + kGap, height + 2 * kTextHeight, kPaper);
  WriteLine(impl_->Title(), kMargin, 0, frame.width, kInk, &frame);
  Paste(impl_->Draw(impl_->close[sample], sample), 0, kTextHeight, &frame);
  Paste(impl_->Draw(impl_->overview, sample), width + kGap, kTextHeight, &frame);
  const std::string numbers = impl_->NumbersAt(sample);
  WriteLine(numbers, kMargin, height + kTextHeight, width, kInk, &frame);
  impl_->WriteEvent(sample, kEventColumn, height + kTextHeight, &frame);
  return frame;
}

Picture RolloutFilm::StoryAt(int sample) const {
  HIRES_CHECK(sample >= 0 && sample < num_samples(), "a sample of the recording");
  const int width = impl_->params.view_width, height = impl_->params.view_height;
  Picture picture(width, height + 3 * kTextHeight, kPaper);
  WriteLine(impl_->Title(), kMargin, 0, width, kInk, &picture);
  Paste(impl_->Draw(impl_->close[sample], sample), 0, kTextHeight, &picture);
  WriteLine(impl_->NumbersAt(sample), kMargin, height + kTextHeight, width, kInk, &picture);
  impl_->WriteEvent(sample, kMargin, height + 2 * kTextHeight, &picture);
  return picture;
}

Picture RolloutFilm::CloseUpAt(int sample) const {
  HIRES_CHECK(sample >= 0 && sample < num_samples(), "a sample of the recording");
  const FilmParams& params = impl_->params;
  Picture picture(params.view_width, params.view_height + kTextHeight, kPaper);
  Paste(impl_->Draw(impl_->close[sample], sample), 0, 0, &picture);
  WriteLine(fmt::format("{:.2f} s", impl_->recording.samples[sample].time), 6, params.view_height,
            picture.width, kInk, &picture);
  return picture;
}

namespace {

/// `draw` gives the frame of a sample, up to `num_samples`.
void WriteFrames(const RolloutFilm& film, int num_samples, const std::function<Picture(int)>& draw,
                 const std::string& path) {
  const int most = film.params().most_frames, step = (num_samples + most - 1) / most;
  std::vector<Picture> frames(static_cast<std::size_t>((num_samples + step - 1) / step));
  InParallel(static_cast<int>(frames.size()), film.params().threads,
             [&](int k) { frames[k] = draw(k * step); });
  const auto& samples = film.recording().samples;
  const double period = samples.size() < 2 ? 0.05 : samples[1].time - samples[0].time;
  base::ReplaceTextFile(path, ToGif(frames, step * period, kLastFrame));
}

}  // namespace

void WriteGif(const RolloutFilm& film, const std::string& path) {
  WriteFrames(
      film, film.num_samples(), [&](int sample) { return film.FrameAt(sample); }, path);
}

void WriteGif(const RolloutFilm& left, const RolloutFilm& right, const std::string& path) {
  const auto draw = [&](int sample) {
    const Picture one = left.StoryAt(std::min(sample, left.num_samples() - 1)),
                  other = right.StoryAt(std::min(sample, right.num_samples() - 1));
    Picture frame(one.width + kGap + other.width, one.height, kPaper);
    Paste(one, 0, 0, &frame);
    Paste(other, one.width + kGap, 0, &frame);
    return frame;
  };
  WriteFrames(left, std::max(left.num_samples(), right.num_samples()), draw, path);
}

std::vector<int> MomentsOf(const RolloutRecording& recording, int count) {
  HIRES_CHECK(count >= 2, "a strip has two pictures at least");
  double begin = recording.samples.front().time, end = recording.samples.back().time;
  double tips = begin;
  for (const RolloutEvent& event : recording.events) {
    if (event.kind == RolloutEvent::Kind::kTips) tips = event.time;
    if (event.kind != RolloutEvent::Kind::kFalls) continue;
    begin = std::max(begin, std::max(tips, event.time - 1.0) - 0.5);
    end = std::min(end, event.time + 1.0);
    break;
  }
  std::vector<int> moments;
  for (int k = 0; k < count; ++k) {
    const double time = begin + (end - begin) * k / (count - 1);
    const auto next =
        std::lower_bound(recording.samples.begin(), recording.samples.end(), time - 1e-6,
                         [](const RolloutSample& sample, double t) { return sample.time < t; });
    moments.push_back(static_cast<int>(
        std::min<std::ptrdiff_t>(next - recording.samples.begin(),
                                 static_cast<std::ptrdiff_t>(recording.samples.size()) - 1)));
  }
  return moments;
}

void WriteStrip(const RolloutFilm& film, int count, const std::string& path) {
  const std::vector<int> moments = MomentsOf(film.recording(), count);
  const int width = film.params().view_width;
  Picture strip(count * (width + kGap) - kGap, film.params().view_height + kTextHeight, kPaper);
  InParallel(count, film.params().threads,
             [&](int k) { Paste(film.CloseUpAt(moments[k]), k * (width + kGap), 0, &strip); });
  base::ReplaceTextFile(path, ToPng(strip));
}

}  // namespace hires::reports
