#include "reports/film/rollout_film.h"

#include <gif_lib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "imagination/room_rollouts.h"
#include "reports/film/film_cameras.h"
#include "reports/film/picture_files.h"
#include "reports/film/picture_text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::reports::rollout_film_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using hires::test_support::TemporaryFolder;
using imagination::RolloutEvent;
using imagination::RolloutRecording;
using imagination::RolloutSetup;
using perception::Colour;
using perception::Picture;
using ::testing::HasSubstr;

FilmParams Small(int threads = 1) {
  FilmParams params;
  params.view_width = 120;
  params.view_height = 90;
  params.most_frames = 6;
  params.threads = threads;
  return params;
}

RolloutRecording Record(const RolloutSetup& setup) {
  return *imagination::RecordRollout(setup, {"move_base_param", {"east", "slow"}}, 0, {});
}

std::string Content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The load is the only thing that is orange.
bool IsOrange(const Colour& colour) { return colour[0] > 2.2 * colour[1] && colour[0] > 60; }

int ReadBytes(GifFileType* file, GifByteType* out, int count) {
  auto* rest = static_cast<std::string*>(file->UserData);
  const int there = std::min(count, static_cast<int>(rest->size()));
  std::copy_n(rest->begin(), there, out);
  rest->erase(0, there);
  return there;
}

/// What a viewer shows after each frame, and how long [s].
struct PlayedGif {
  explicit PlayedGif(std::string bytes) {
    int error = 0;
    GifFileType* file = DGifOpen(&bytes, &ReadBytes, &error);
    EXPECT_NE(file, nullptr);
    EXPECT_EQ(DGifSlurp(file), GIF_OK);
    Picture screen(file->SWidth, file->SHeight);
    for (int k = 0; k < file->ImageCount; ++k) {
      GraphicsControlBlock control{};
      DGifSavedExtensionToGCB(file, k, &control);
      for (std::size_t i = 0; i < screen.pixels.size(); ++i) {
        const int index = file->SavedImages[k].RasterBits[i];
        if (index == control.TransparentColor) continue;
        const GifColorType& colour = file->SColorMap->Colors[index];
        screen.pixels[i] = {colour.Red, colour.Green, colour.Blue};
      }
      frames.push_back(screen);
      delays.push_back(0.01 * control.DelayTime);
    }
    DGifCloseFile(file, nullptr);
  }
  std::vector<Picture> frames;
  std::vector<double> delays;
};

double MeanDifference(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (int k = 0; k < 3; ++k) sum += std::abs(a.pixels[i][k] - b.pixels[i][k]);
  }
  return sum / (3.0 * a.pixels.size());
}

TEST(PictureFilesTest, APngHoldsThePictureToTheLastBit) {
  Picture picture(7, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    picture.pixels[i] = {static_cast<std::uint8_t>(11 * i), static_cast<std::uint8_t>(255 - 3 * i),
                         static_cast<std::uint8_t>(i * i)};
  }
  const std::string bytes = ToPng(picture);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  image.format = PNG_FORMAT_RGB;
  Picture read(static_cast<int>(image.width), static_cast<int>(image.height));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, read.pixels.data(), 0, nullptr));
  EXPECT_EQ(read.width, 7);
  EXPECT_EQ(read.pixels, picture.pixels);
}

TEST(PictureFilesTest, AGifShowsItsFramesOneAfterTheOther) {
  Picture first(40, 30, {200, 30, 20}), second = first;
  for (int row = 10; row < 20; ++row) second.At(7, row) = second.At(9, row) = {20, 40, 220};
  Picture third(40, 30, {90, 90, 90});
  const PlayedGif gif(ToGif({first, second, third}, 0.15, 2.0));
  ASSERT_EQ(gif.frames.size(), 3u);
  EXPECT_EQ(gif.delays, (std::vector<double>{0.15, 0.15, 2.0}));
  EXPECT_LT(MeanDifference(gif.frames[0], first), 1.0);
  EXPECT_LT(MeanDifference(gif.frames[1], second), 1.0);
  EXPECT_LT(MeanDifference(gif.frames[2], third), 1.0);
}

TEST(PictureFilesTest, FramesOfTwoSizesAreRefused) {
  EXPECT_THROW(ToGif({Picture(4, 4), Picture(5, 4)}, 0.1, 1.0), std::logic_error);
  EXPECT_THROW(ToGif({}, 0.1, 1.0), std::logic_error);
}

TEST(PictureTextTest, TextStaysLeftOfItsEnd) {
  Picture paper(300, kTextHeight, {255, 255, 255});
  WriteLine("a line that is much too long for the place that it has", 10, 0, 100, {0, 0, 0},
            &paper);
  bool has_ink = false;
  for (int row = 0; row < paper.height; ++row) {
    for (int column = 0; column < paper.width; ++column) {
      const bool is_ink = paper.At(column, row)[0] < 128;
      has_ink = has_ink || is_ink;
      if (column > 101 || column < 9) {
        EXPECT_FALSE(is_ink) << column;
      }
    }
  }
  EXPECT_TRUE(has_ink);
}

TEST(FilmCamerasTest, TheLoadIsWhatStandsOnTheTrayOrIsNamed) {
  RolloutRecording recording = Record(RoomRollouts(Room(), "mill"));
  const geometry::Pose3 X_BO = RoomRollouts(Room(), "mill").scene->X_BO;
  EXPECT_EQ(LoadOf(recording, X_BO), 0);
  for (auto& sample : recording.samples) sample.X_MO[0].translation.x() += 2.0;
  EXPECT_EQ(LoadOf(recording, X_BO), std::nullopt);
  recording.action.arguments.push_back("LOAD");
  EXPECT_EQ(LoadOf(recording, X_BO), 0);
}

TEST(FilmCamerasTest, TheCloseOneHoldsTheLoadInTheMiddleAndStaysWhereItFell) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  RolloutRecording recording = Record(setup);
  const std::size_t half = recording.samples.size() / 2;
  for (std::size_t i = half; i < recording.samples.size(); ++i) {  // it falls off beside the robot
    recording.samples[i].X_MO[0].translation =
        recording.samples[half - 1].X_MO[0].translation + Eigen::Vector3d(0.0, 0.6, -0.3);
  }
  const auto cameras = CloseCameras(recording, 0, setup.scene->X_BO, 120, 90);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Eigen::Vector3d p_M = recording.samples[i].X_MO[0] * Eigen::Vector3d(0.0, 0.0, 0.10);
    const auto pixel = cameras[i].Project(p_M);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - Eigen::Vector2d(60, 45)).norm(), 6.0) << i;
    if (i > half) {
      EXPECT_EQ(cameras[i].X_MC.translation, cameras[half].X_MC.translation);
    }
  }
}

TEST(FilmCamerasTest, TheOtherOneSeesTheWholeDrive) {
  const RolloutRecording recording = Record(RoomRollouts(Room(), "mill"));
  const auto camera = OverviewCamera(recording, 120, 90);
  for (const auto& sample : recording.samples) {
    const auto pixel = camera.Project(sample.X_MB.translation);
    ASSERT_TRUE(pixel);
    EXPECT_TRUE(pixel->x() > 0 && pixel->x() < 120 && pixel->y() > 0 && pixel->y() < 90);
  }
}

TEST(RolloutFilmTest, TheLoadIsSeenCloseUp) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  const RolloutRecording recording = Record(setup);
  const RolloutFilm film(setup, recording, Small());
  for (const int sample : {0, film.num_samples() / 2, film.num_samples() - 1}) {
    const Picture picture = film.CloseUpAt(sample);
    int orange = 0;
    for (int row = 30; row < 60; ++row) {
      for (int column = 45; column < 75; ++column) orange += IsOrange(picture.At(column, row));
    }
    EXPECT_GT(orange, 60) << sample;
  }
}

TEST(RolloutFilmTest, WhatIsLeftOutOfPhysicsIsDrawnAllTheSame) {
  RolloutSetup setup = RoomRollouts(Room(), "mill");
  const RolloutRecording recording = Record(setup);
  const Picture without = RolloutFilm(setup, recording, Small()).FrameAt(0);
  world::ObjectState bystander = setup.world_state.objects[0];
  bystander.name = "bystander";
  bystander.X_MO.translation = {3.0, 3.2, 0.0};
  setup.world_state.objects.push_back(bystander);
  EXPECT_NE(RolloutFilm(setup, recording, Small()).FrameAt(0).pixels, without.pixels);
}

TEST(RolloutFilmTest, AnyNumberOfThreadsWritesTheSameFile) {
  const TemporaryFolder folder;
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  const RolloutRecording recording = Record(setup);
  const std::string one = (folder.path() / "one.gif").string(),
                    three = (folder.path() / "three.gif").string();
  WriteGif(RolloutFilm(setup, recording, Small(1)), one);
  WriteGif(RolloutFilm(setup, recording, Small(3)), three);
  EXPECT_EQ(Content(one), Content(three));
  const PlayedGif gif(Content(one));
  EXPECT_LE(gif.frames.size(), 6u);
  EXPECT_EQ(gif.frames[0].width, 2 * 120 + 4);
  double length = 0.0;
  for (const double delay : gif.delays) length += delay;
  EXPECT_NEAR(length - 2.0, recording.samples.back().time, 2.5);  // real time; six frames of it
  const RolloutFilm film(setup, recording, Small());
  EXPECT_LT(MeanDifference(gif.frames[0], film.FrameAt(0)), 6.0);
}

TEST(RolloutFilmTest, TwoRolloutsPlayBesideEachOtherUntilTheLongerOneEnds) {
  const TemporaryFolder folder;
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  const RolloutRecording recording = Record(setup);
  RolloutRecording shorter = recording;
  shorter.samples.resize(recording.samples.size() / 2);
  const RolloutFilm left(setup, shorter, Small(2)), right(setup, recording, Small(2));
  const std::string path = (folder.path() / "both.gif").string();
  WriteGif(left, right, path);
  const PlayedGif gif(Content(path));
  ASSERT_GE(gif.frames.size(), 4u);
  EXPECT_EQ(gif.frames[0].width, 2 * 120 + 4);
  EXPECT_EQ(gif.frames[0].height, 90 + 3 * kTextHeight);
  const auto half = [&](std::size_t frame, int from) {  // the view, without text
    Picture part(120, 90);
    for (int row = 0; row < 90; ++row) {
      for (int column = 0; column < 120; ++column) {
        part.At(column, row) = gif.frames[frame].At(from + column, row + kTextHeight);
      }
    }
    return part;
  };
  const std::size_t last = gif.frames.size() - 1;
  EXPECT_EQ(half(0, 0).pixels, half(0, 124).pixels);          // the same moment
  EXPECT_EQ(half(last, 0).pixels, half(last - 1, 0).pixels);  // the shorter one is over
  EXPECT_NE(half(last, 0).pixels, half(last, 124).pixels);
}

TEST(RolloutFilmTest, AStripHasItsPicturesSideBySide) {
  const TemporaryFolder folder;
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  const RolloutRecording recording = Record(setup);
  const std::string path = (folder.path() / "strip.png").string();
  WriteStrip(RolloutFilm(setup, recording, Small(2)), 3, path);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, path.c_str()));
  EXPECT_EQ(image.width, 3u * 120 + 2 * 4);
  EXPECT_EQ(image.height, 90u + kTextHeight);
  png_image_free(&image);
}

TEST(MomentsOfTest, EvenlyFromBeginToEndOrAroundAFall) {
  RolloutRecording recording;
  for (int i = 1; i <= 200; ++i) {
    recording.samples.emplace_back();
    recording.samples.back().time = 0.05 * i;
  }
  const std::vector<int> even = MomentsOf(recording, 3);
  EXPECT_EQ(even.front(), 0);
  EXPECT_NEAR(even[1], 100, 1);
  EXPECT_EQ(even.back(), 199);
  // It begins to tip at 5.8 s and falls at 6 s: looked at are 5.3 .. 7 s.
  recording.events = {{RolloutEvent::Kind::kTips, 5.8, ""}, {RolloutEvent::Kind::kFalls, 6.0, ""}};
  const std::vector<int> fall = MomentsOf(recording, 2);
  EXPECT_NEAR(recording.samples[fall[0]].time, 5.3, 0.051);
  EXPECT_NEAR(recording.samples[fall[1]].time, 7.0, 0.051);
  EXPECT_THROW(MomentsOf(recording, 1), std::logic_error);
}

TEST(RolloutFilmTest, ARolloutThatCouldNotBeginIsRefused) {
  RolloutRecording recording;
  recording.action = {"move_base_param", {"east", "slow"}};
  EXPECT_THAT(ConfigErrorOf([&] { RolloutFilm(RoomRollouts(Room(), "mill"), recording); }),
              HasSubstr("rollout 0 of move_base_param(east, slow) ended before"));
}

TEST(RolloutFilmTest, AFileThatCannotBeWrittenIsNamed) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  const RolloutRecording recording = Record(setup);
  const RolloutFilm film(setup, recording, Small());
  EXPECT_THAT(ConfigErrorOf([&] { WriteGif(film, "/no/such/folder/film.gif"); }),
              HasSubstr("/no/such/folder/film.gif"));
}

}  // namespace
}  // namespace hires::reports::rollout_film_test
