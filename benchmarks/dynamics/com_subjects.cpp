// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/dynamics/com_subjects.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "benchmarks/dynamics/jump_clips.h"
#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/retarget/scaled_bodies.h"
#include "core/base/smooth_step.h"
#include "core/human/centre_of_mass.h"
#include "core/pose.h"
#include "retarget/base/smooth_cover.h"
#include "retarget/character/make_character.h"
#include "retarget/com/foot_goals.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/motion/retarget_motion.h"

namespace marey {
namespace {

constexpr double kHoldFade_s = 0.08;  // Half of a foot's fade, as edit's hold_feet().
constexpr double kAdultLeg_m = 0.9;
constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kMaxFrames = 600;

constexpr std::array kStatures{Stature{"0.6 m", 0.6, 0.9, 1.1},
                               Stature{"1.1 m", 1.1, 0.95, 1.05},
                               Stature{"1.75 m", 1.75, 1.0, 1.0},
                               Stature{"1.9 m, long legs", 1.9, 1.15, 0.9},
                               Stature{"2.5 m", 2.5, 1.0, 1.0}};

// 0, 1 and 0 again in two seconds.
double swell(double time_s) {
  return 0.5 - 0.5 * std::cos(kPi * time_s);
}
const std::array<Course, 4> kCourses{{
    {"10 cm deeper", [](double t) { return glm::dvec3(0, -0.1 * swell(t), 0); }},
    {"5 cm higher", [](double t) { return glm::dvec3(0, 0.05 * swell(t), 0); }},
    {"5 cm sideways", [](double t) { return glm::dvec3(0.05 * swell(t), 0, 0); }},
    {"8 cm down and up, 1.2 s",
     [](double t) {
       const double wave = std::sin(2.0 * kPi * t / 1.2) * smooth_step(t / 0.6);
       return glm::dvec3(0, -0.08 * wave, 0);
     }},
}};

std::vector<double> holds(const FootContacts& foot, FrameRate rate, std::size_t frames) {
  std::vector<double> stands(frames, 0.0);
  for (const FrameRange& run : foot.stance) {
    std::fill(stands.begin() + run.first, stands.begin() + run.last + 1, 1.0);
  }
  std::vector<double> out = retarget::smooth_cover(stands, half_fade(rate));
  for (std::size_t t = 0; t < frames; ++t) {
    out[t] = stands[t] > 0.0 ? 1.0 : std::min(1.0, out[t]);
  }
  return out;
}

}  // namespace

const std::array<Stature, 5>& statures() {
  return kStatures;
}

const std::array<Course, 4>& courses() {
  return kCourses;
}

int half_fade(FrameRate rate) {
  return std::max(1, static_cast<int>(std::lround(kHoldFade_s * rate.hz)));
}

Result<Subject> subject_of(const std::string& name,
                           Motion source,
                           const Stature& stature) {
  if (source.poses.size() > kMaxFrames) source.poses.resize(kMaxFrames);
  const auto source_map = retarget::map_body(source.skeleton);
  if (!source_map) return source_map.error();
  const double by =
      stature.height_m / retarget::head_height_m(source.skeleton, *source_map);
  const Skeleton avatar =
      scaled(source.skeleton,
             {stature.name, by * stature.legs, by * stature.trunk, by * stature.trunk});
  auto made = retarget::retarget_motion(source, avatar);
  if (!made) return made.error();
  auto map = retarget::map_body(avatar);
  if (!map) return map.error();
  auto character = retarget::make_character(name, avatar, *map);
  if (!character) return character.error();
  Subject out{std::move(made->motion), *std::move(character), *std::move(map), {}, {}};
  for (const Pose& pose : out.motion.poses) {
    out.com.push_back(centre_of_mass(out.character.masses,
                                     world_from_joints(out.motion.skeleton, pose)));
  }
  const Contacts contacts = retarget::detect_contacts(out.motion, out.map);
  const std::vector<double> ones(out.com.size(), 1.0);
  for (std::size_t side = 0; side < 2; ++side) {
    const auto hold = holds(contacts.feet[side], out.motion.rate, out.com.size());
    out.feet[side] = retarget::foot_goals(
        out.motion, out.map, static_cast<int>(side), {{}, hold, ones});
  }
  return out;
}

std::vector<glm::dvec3> displaced_m(const Subject& subject, const Course& course) {
  std::vector<glm::dvec3> out;
  const double scale = subject.map.leg_length_m / kAdultLeg_m;
  for (std::size_t t = 0; t < subject.com.size(); ++t) {
    out.push_back(scale *
                  course.displaced_m(static_cast<double>(t) / subject.motion.rate.hz));
  }
  return out;
}

Result<std::vector<NamedMotion>> read_motions(const std::filesystem::path& data) {
  std::vector<NamedMotion> out;
  auto clips = read_clips(data / "mocap", ClipSet::kAll);
  if (!clips) return clips.error();
  for (CapturedClip& clip : *clips) {
    out.push_back(
        {clip.name, {clip.character.skeleton, {clip.rate_hz}, 0, std::move(clip.poses)}});
  }
  std::vector<JumpClip> jumps = plate_clips(data / "mocap");
  if (auto jump = read_second_drop_jump(data / "mocap"))
    jumps.push_back(*std::move(jump));
  if (auto jump = read_rendered_jump(data)) jumps.push_back(*std::move(jump));
  for (JumpClip& clip : jumps) out.push_back({clip.name, std::move(clip.motion)});
  return out;
}

}  // namespace marey
