// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/marker_file.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_markers.h"
#include "tests/recordings/markers/c3d_example.h"
#include "tests/recordings/markers/has_note.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// A subject who walks along X, heels to head, with gaps. Fixed seed 5.
MarkerFile walker(std::size_t frames = 40) {
  MarkerFile file;
  file.tracks.labels = {"LHEE", "RHEE", "LKNE", "SACR", "HEAD"};
  file.tracks.rate = FrameRate{100.0};
  file.tracks.first_frame = 11;
  file.tracks.start_s = 0.1;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shake(-0.01, 0.01);
  const std::vector<double> heights{0.05, 0.05, 0.5, 1.0, 1.75};
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t m = 0; m < heights.size(); ++m) {
      std::optional<MarkerSample> sample;
      if ((f + 7 * m) % 9 != 0) {
        const double x = 0.05 * static_cast<double>(f) + shake(random);
        sample = MarkerSample{{x, heights[m] + shake(random), shake(random) - 0.5},
                              0.0005F * static_cast<float>(1 + m),
                              static_cast<std::uint8_t>(1 + m),
                              Source::kMeasured};
      }
      if (sample && f % 10 == 3) {
        sample->source = Source::kRepaired;
        sample->sigma_m = 0.0F;
        sample->cameras = 0;
      }
      file.tracks.samples.push_back(sample);
    }
  }
  file.events = {{"Foot Strike", "Left", "S1", 0.25}, {"Foot Off", "Right", "S1", 1.5}};
  return file;
}

MarkerFile through_file(const std::filesystem::path& path,
                        const MarkerFile& markers,
                        const MarkerWriteOptions& options = {}) {
  const Status written = write_markers(path, markers, options);
  EXPECT_TRUE(written) << written.error().message();
  auto read = read_markers(path);
  EXPECT_TRUE(read) << read.error().message();
  return read ? *std::move(read) : MarkerFile{};
}

/// Returns the largest distance of samples; infinite if one of both is missing. [m]
double largest_error_m(const MarkerTracks& a, const MarkerTracks& b) {
  if (a.labels != b.labels || a.samples.size() != b.samples.size()) return INFINITY;
  double largest = 0.0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    if (a.samples[i].has_value() != b.samples[i].has_value()) return INFINITY;
    if (!a.samples[i]) continue;
    largest = std::max(largest,
                       glm::distance(a.samples[i]->p_in_world, b.samples[i]->p_in_world));
  }
  return largest;
}

TEST(MarkerFile, AC3dOfEveryUnitAndUpwardAxisHoldsTheSameMarkers) {
  const ScratchFolder folder;
  const MarkerFile markers = walker();
  for (const std::string unit : {"mm", "cm", "m"}) {
    for (int up = 0; up < 6; ++up) {
      FileAxes axes;
      axes.unit = unit;
      axes.per_metre = *units_per_metre(unit);
      axes.up = static_cast<FileAxis>(up);
      const MarkerFile read =
          through_file(folder / "a.c3d", markers, {.axes = axes, .source = {}});
      // A 32-bit real of 2 m has steps of 0.12 um.
      EXPECT_LT(largest_error_m(read.tracks, markers.tracks), 4e-7) << unit << up;
      EXPECT_EQ(read.axes.up, axes.up);
      EXPECT_EQ(read.axes.up_from, Evidence::kFile);
      EXPECT_EQ(read.axes.unit, unit);
      EXPECT_TRUE(read.notes.empty()) << read.notes[0];
      EXPECT_EQ(read.tracks.first_frame, 11);
      EXPECT_DOUBLE_EQ(read.tracks.start_s, 0.1);
      EXPECT_EQ(read.tracks.rate.hz, 100.0);
    }
  }
}

TEST(MarkerFile, KeepsRepairsCamerasAndUncertaintyInC3d) {
  const ScratchFolder folder;
  const MarkerFile markers = walker();
  const MarkerFile read = through_file(folder / "a.c3d", markers);
  for (std::size_t i = 0; i < markers.tracks.samples.size(); ++i) {
    const auto& wanted = markers.tracks.samples[i];
    if (!wanted) continue;
    EXPECT_EQ(read.tracks.samples[i]->source, wanted->source) << i;
    EXPECT_EQ(read.tracks.samples[i]->cameras, wanted->cameras) << i;
    // Residuals are bytes: half a step of 1/32767 of the largest coordinate.
    EXPECT_NEAR(read.tracks.samples[i]->sigma_m, wanted->sigma_m, 4e-5) << i;
  }
  ASSERT_EQ(read.events.size(), 2U);
  EXPECT_EQ(read.events[0].label, "Foot Strike");
  EXPECT_EQ(read.events[0].context, "Left");
  EXPECT_EQ(read.events[1].subject, "S1");
  EXPECT_EQ(read.events[1].time_s, 1.5);
}

TEST(MarkerFile, ATrcHoldsTheSameMarkersToTheLastBit) {
  const ScratchFolder folder;
  MarkerFile markers = walker();
  markers.axes.up = FileAxis::kPlusY;
  const MarkerFile once = through_file(folder / "a.trc", markers);
  // Millimetres cannot hold every metre exactly.
  EXPECT_LT(largest_error_m(once.tracks, markers.tracks), 1e-15);
  const MarkerFile twice = through_file(folder / "b.trc", once);
  EXPECT_EQ(largest_error_m(twice.tracks, once.tracks), 0.0);
  FileAxes metres;
  metres.unit = "m";
  metres.per_metre = 1.0;
  metres.up = FileAxis::kPlusZ;
  const MarkerFile exact =
      through_file(folder / "c.trc", markers, {.axes = metres, .source = {}});
  EXPECT_EQ(exact.axes.up, FileAxis::kPlusZ);
  EXPECT_EQ(largest_error_m(exact.tracks, markers.tracks), 0.0);
}

TEST(MarkerFile, WritesUnchangedDataOverItsSourceBitForBit) {
  const ScratchFolder folder;
  for (const auto processor :
       {C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips}) {
    for (const auto numbers : {C3dNumbers::kReal, C3dNumbers::kInteger}) {
      const C3dInfo info = example_info(processor, numbers);
      write_frames(folder / "a.c3d", info, example_frames(info));
      const auto read = read_markers(folder / "a.c3d");
      ASSERT_TRUE(read) << read.error().message();
      const Status written = write_markers(
          folder / "b.c3d", *read, {.axes = {}, .source = folder / "a.c3d"});
      ASSERT_TRUE(written) << written.error().message();
      EXPECT_EQ(*read_file(folder / "a.c3d"), *read_file(folder / "b.c3d"));
    }
  }
}

TEST(MarkerFile, AFilledGapChangesItsOwnWordsAlone) {
  const ScratchFolder folder;
  const C3dInfo info = example_info(C3dProcessor::kDec, C3dNumbers::kInteger);
  const std::vector<C3dFrame> frames = example_frames(info);
  write_frames(folder / "a.c3d", info, frames);
  auto read = read_markers(folder / "a.c3d");
  ASSERT_TRUE(read);
  ASSERT_FALSE(read->tracks.at(1, 1));
  // 100 mm along each axis of the file, whose Z is up.
  read->tracks.at(1, 1) = MarkerSample{{0.1, 0.1, -0.1}, 0.004F, 0, Source::kRepaired};
  ASSERT_TRUE(
      write_markers(folder / "b.c3d", *read, {.axes = {}, .source = folder / "a.c3d"}));
  Result<C3dReader> reader = C3dReader::open(folder / "b.c3d");
  ASSERT_TRUE(reader);
  std::vector<C3dFrame> wanted = frames;
  const std::vector<float> filled{800.0F, 800.0F, 800.0F, 0.0F};
  std::copy(filled.begin(), filled.end(), wanted[1].points.begin() + 4);
  const std::vector<C3dFrame> found = frames_of(*reader);
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    EXPECT_EQ(found[f].points, wanted[f].points) << f;
    EXPECT_EQ(found[f].analog, wanted[f].analog) << f;
  }
}

TEST(MarkerFile, MarkersOfAnotherFileAreNotWrittenOverASource) {
  const ScratchFolder folder;
  const C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  write_frames(folder / "a.c3d", info, example_frames(info));
  const Status written =
      write_markers(folder / "b.c3d", walker(), {.axes = {}, .source = folder / "a.c3d"});
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message().find("other markers or frames"), std::string::npos);
}

/// Returns the axes found for the walker in a C3D without screen parameters and units.
MarkerFile found_axes(FileAxis up, double per_metre) {
  const ScratchFolder folder;
  MarkerFile markers = walker();
  markers.axes.up = up;
  markers.axes.per_metre = per_metre;
  markers.axes.unit = "?";
  C3dInfo info;
  info.points = static_cast<int>(markers.tracks.markers());
  info.frames = static_cast<std::int64_t>(markers.tracks.frames());
  put_texts(info.groups, "POINT", "LABELS", markers.tracks.labels);
  std::vector<C3dFrame> frames;
  for (std::size_t f = 0; f < markers.tracks.frames(); ++f) {
    C3dFrame frame;
    frame.points.resize(4 * markers.tracks.markers());
    for (std::size_t m = 0; m < markers.tracks.markers(); ++m) {
      put_c3d_sample(info, markers.axes, markers.tracks.at(f, m), &frame.points[4 * m]);
    }
    frames.push_back(frame);
  }
  write_frames(folder / "a.c3d", info, frames);
  const auto read = read_markers(folder / "a.c3d");
  EXPECT_TRUE(read) << read.error().message();
  return *read;
}

TEST(MarkerFile, UnitAndUpwardAxisAreFoundWhereTheFileIsSilent) {
  for (const double per_metre : {1.0, 100.0, 1000.0}) {
    for (int up = 0; up < 6; ++up) {
      const MarkerFile read = found_axes(static_cast<FileAxis>(up), per_metre);
      EXPECT_EQ(read.axes.up, static_cast<FileAxis>(up));
      EXPECT_EQ(read.axes.up_from, Evidence::kMarkers);
      EXPECT_EQ(read.axes.per_metre, per_metre);
      EXPECT_EQ(read.axes.unit_from, Evidence::kMarkers);
      EXPECT_TRUE(has_note(read, "POINT:UNITS is missing"));
      EXPECT_LT(largest_error_m(read.tracks, walker().tracks), 1e-6);
    }
  }
}

TEST(MarkerFile, TurnsAnUpsideDownCaptureAndReportsIt) {
  const ScratchFolder folder;
  MarkerFile markers = walker();
  FileAxes axes;
  axes.up = FileAxis::kPlusZ;
  // The file will state +Z, and the walker is upside down.
  for (auto& sample : markers.tracks.samples) {
    if (sample) sample->p_in_world *= glm::dvec3(1.0, -1.0, -1.0);
  }
  const MarkerFile read =
      through_file(folder / "a.c3d", markers, {.axes = axes, .source = {}});
  EXPECT_EQ(read.axes.up, FileAxis::kMinusZ);
  EXPECT_TRUE(has_note(read, "upside down"));
  EXPECT_LT(largest_error_m(read.tracks, walker().tracks), 1e-6);
}

TEST(MarkerFile, RejectsAnAxisThatMarkersAndPlatesContradict) {
  const ScratchFolder folder;
  MarkerFile markers = walker();
  markers.axes.up = FileAxis::kPlusZ;
  ASSERT_TRUE(write_markers(folder / "a.c3d", markers));
  Result<C3dReader> reader = C3dReader::open(folder / "a.c3d");
  ASSERT_TRUE(reader);
  C3dInfo info = reader->info();
  const std::vector<C3dFrame> frames = frames_of(*reader);
  put_texts(info.groups, "POINT", "Y_SCREEN", {"+Y"});
  write_frames(folder / "b.c3d", info, frames);
  const auto contradicted = read_markers(folder / "b.c3d");
  ASSERT_TRUE(contradicted);
  EXPECT_EQ(contradicted->axes.up, FileAxis::kPlusY);
  EXPECT_TRUE(
      has_note(*contradicted, "the markers stand along +Z; the file's axis is used"));
  // A plate whose z axis points along the file's -Z.
  const C3dReals corners{600, 400, 0, 0, 400, 0, 0, 0, 0, 600, 0, 0};
  C3dReals down = corners;
  std::swap_ranges(down.begin() + 3, down.begin() + 6, down.begin() + 9);
  put_parameter(info.groups, "FORCE_PLATFORM", {"CORNERS", "", false, {3, 4, 1}, down});
  write_frames(folder / "c.c3d", info, frames);
  const auto corrected = read_markers(folder / "c.c3d");
  ASSERT_TRUE(corrected);
  EXPECT_EQ(corrected->axes.up, FileAxis::kPlusZ);
  EXPECT_TRUE(has_note(*corrected, "the markers' axis is used"));
}

TEST(MarkerFile, TheReadersWordOnAxesComesFirst) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_markers(folder / "a.c3d", walker()));
  const auto read = read_markers(folder / "a.c3d", {.up = FileAxis::kPlusY, .unit = "m"});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->axes.up, FileAxis::kPlusY);
  EXPECT_EQ(read->axes.up_from, Evidence::kUser);
  EXPECT_EQ(read->axes.per_metre, 1.0);
}

TEST(MarkerFile, LabelsThatAreMissingOrDoubleAreMadeDifferent) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  put_texts(info.groups, "POINT", "LABELS", {"toe", "toe"});
  write_frames(folder / "a.c3d", info, example_frames(info));
  const auto read = read_markers(folder / "a.c3d");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->tracks.labels, (std::vector<std::string>{"toe", "toe_2", "unnamed_3"}));
  EXPECT_TRUE(has_note(*read, "no label"));
  EXPECT_TRUE(has_note(*read, "labels that occur before"));
}

TEST(MarkerFile, ReportsMarkersThatAreNeverSeen) {
  const ScratchFolder folder;
  MarkerFile markers = walker();
  for (std::size_t f = 0; f < markers.tracks.frames(); ++f) {
    markers.tracks.at(f, 2).reset();
  }
  const MarkerFile read = through_file(folder / "a.c3d", markers);
  EXPECT_TRUE(has_note(read, "1 of 5 markers are never seen"));
  EXPECT_EQ(largest_error_m(read.tracks, markers.tracks) < 1e-6, true);
}

// SIMI's files: residuals of -1 everywhere, with valid positions.
TEST(MarkerFile, PositionsAreTakenWhenEverySampleIsMarkedUnseen) {
  const ScratchFolder folder;
  const C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  std::vector<C3dFrame> frames = example_frames(info);
  for (C3dFrame& frame : frames) {
    for (std::size_t w = 3; w < frame.points.size(); w += 4) frame.points[w] = -1.0F;
  }
  write_frames(folder / "a.c3d", info, frames);
  const auto read = read_markers(folder / "a.c3d");
  ASSERT_TRUE(read);
  EXPECT_TRUE(has_note(*read, "every sample is marked as not seen"));
  EXPECT_TRUE(read->tracks.at(0, 1));
  // All three coordinates are 0 there.
  EXPECT_FALSE(read->tracks.at(1, 1));
}

TEST(MarkerFile, OneFrameWithoutARateIsRead) {
  const ScratchFolder folder;
  MarkerFile markers = walker(1);
  markers.tracks.first_frame = 1;
  const MarkerFile read = through_file(folder / "a.c3d", markers);
  EXPECT_EQ(read.tracks.frames(), 1U);
}

TEST(MarkerFile, AFileWithoutMarkersIsReadAsSuch) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  info.points = 0;
  write_frames(folder / "a.c3d", info, example_frames(info));
  const auto read = read_markers(folder / "a.c3d");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->tracks.frames(), 0U);
  EXPECT_TRUE(has_note(*read, "no markers"));
}

// Theia's files: a section of matrices after the frames, in a group of its own.
TEST(MarkerFile, ReportsAndOmitsRotationsBehindTheFrames) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  put_parameter(info.groups, "ROTATION", {"DATA_START", "", false, {}, C3dIntegers{9}});
  write_frames(folder / "a.c3d", info, example_frames(info));
  std::string bytes = *read_file(folder / "a.c3d");
  bytes.resize(bytes.size() + 9000, 'r');
  ASSERT_TRUE(write_file(folder / "b.c3d", bytes));
  const auto read = read_markers(folder / "b.c3d");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->tracks.frames(), 5U);
  EXPECT_TRUE(has_note(*read, "ROTATION"));
  ASSERT_TRUE(
      write_markers(folder / "c.c3d", *read, {.axes = {}, .source = folder / "b.c3d"}));
  const auto again = read_markers(folder / "c.c3d");
  ASSERT_TRUE(again);
  EXPECT_FALSE(has_note(*again, "ROTATION"));
  EXPECT_EQ(largest_error_m(again->tracks, read->tracks), 0.0);
}

TEST(MarkerFile, OtherKindsAreRefused) {
  EXPECT_FALSE(read_markers("walk.csv"));
  EXPECT_FALSE(write_markers("walk.csv", walker()));
  const auto absent = read_markers("absent.c3d");
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message().find("does not exist"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
