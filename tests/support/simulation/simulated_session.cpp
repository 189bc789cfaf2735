// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace marey::testing {
namespace {

constexpr int kRangePostures = 80;

std::vector<Attitude> postures_of(const Exercise& exercise) {
  std::vector<Attitude> postures;
  for (int i = 0; i < kRangePostures; ++i) {
    postures.push_back(exercise.at(exercise.duration_s * i / kRangePostures));
  }
  return postures;
}

/// Tags are printed to be seen: larger for small pictures.
TagStyle draw_style(Dice& dice, int picture_height_px) {
  TagStyle style;
  const double many = dice.between(0.0, 1.0);
  style.max_per_segment = many < 0.2 ? 1 : many < 0.6 ? 2 : 3;
  style.size_m =
      picture_height_px > 720 ? dice.between(0.065, 0.1) : dice.between(0.08, 0.1);
  style.slide_m = dice.between(0.0, 1.0) < 0.3 ? 0.0 : dice.between(0.001, 0.008);
  return style;
}

struct Recorder {
  const SimulatedScene& scene;
  const std::vector<Camera>& cameras;
  double exposure_s;
  double sigma_factor;
  Dice& dice;

  SimulatedTrial record(const std::string& name,
                        const Exercise& exercise,
                        double hz,
                        double max_offset_s) const {
    SimulatedFilm how;
    how.name = name;
    how.hz = hz;
    how.frames = static_cast<int>(exercise.duration_s * hz);
    how.exposure_s = exposure_s;
    how.sigma_factor = sigma_factor;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      how.offsets_s.push_back(c == 0 ? 0.0 : dice.between(-max_offset_s, max_offset_s));
    }
    return {exercise, hz, how.offsets_s, film(scene, exercise, cameras, how, dice)};
  }
};

}  // namespace

std::vector<TagOnSegment> SimulatedSession::declared_tags() const {
  std::vector<TagOnSegment> declared;
  for (const GluedTag& tag : tags) declared.push_back(tag.tag);
  return declared;
}

BoneFrames SimulatedSession::truth(const SimulatedTrial& trial, double time_s) const {
  return place(body, trial.exercise.at(time_s));
}

std::string SimulatedSession::summary() const {
  std::array<char, 240> line{};
  std::snprintf(line.data(),
                line.size(),
                "%zu cameras (%s, %dp), %zu tags (up to %d a segment, %.0f mm, slide "
                "%.1f mm), %.2f m (stated %.2f), %s, %s, %s",
                rig.cameras.size(),
                rig.layout.c_str(),
                rig.cameras.front().intrinsics.height_px,
                tags.size(),
                style.max_per_segment,
                1e3 * style.size_m,
                1e3 * style.slide_m,
                body.stature_m,
                body.declared_stature_m,
                standing.exercise.name.c_str(),
                moving.exercise.name.c_str(),
                motion.exercise.name.c_str());
  return line.data();
}

SimulatedSession simulate_session(std::uint64_t seed) {
  // Neighbouring seeds of the engine are not independent enough without this.
  Dice dice(seed * 0x9E3779B97F4A7C15ULL + 0x5851F42DULL);
  SimulatedSession s;
  s.seed = seed;
  s.body = draw_body(dice);
  s.rig = draw_rig(dice);
  s.style = draw_style(dice, s.rig.cameras.front().intrinsics.height_px);
  s.diligence = dice.between(0.0, 1.0) < 0.75 ? Diligence::kGood : Diligence::kLazy;
  const double heading = s.rig.heading_rad;
  const Exercise standing = draw_standing(dice, heading);
  const Exercise moving = draw_range_of_motion(dice, s.diligence, heading);
  const Exercise motion = draw_motion(dice, heading);
  s.reference = standing.base;
  const std::vector<SoftTissuePart> soft_tissue = soft_tissue_of(s.body);
  s.tags =
      glue_tags(s.body, soft_tissue, s.style, postures_of(moving), s.reference, dice);
  const SimulatedScene scene{&s.body, &soft_tissue, &s.tags, s.reference};
  const Recorder recorder{
      scene, s.rig.cameras, dice.between(0.004, 0.012), dice.between(0.9, 1.15), dice};
  s.standing = recorder.record("static", standing, 15.0, 0.005);
  const double moving_hz = s.diligence == Diligence::kGood ? 10.0 : 30.0;
  s.moving = recorder.record("rom", moving, moving_hz, 0.005);
  s.motion = recorder.record("motion", motion, 30.0, 0.015);
  return s;
}

}  // namespace marey::testing
