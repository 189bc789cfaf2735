// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/dynamics/jump_clips.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "app/motion/retarget_files.h"
#include "benchmarks/retarget/plate_clock.h"
#include "retarget/body/body_track.h"
#include "retarget/body/place_masses.h"
#include "tests/support/truth/truth_motion.h"

namespace marey {
namespace {

[[noreturn]] void stop_reading(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  std::exit(1);
}

JumpClip or_stop(Result<JumpClip> clip) {
  if (!clip) stop_reading(clip.error());
  return *std::move(clip);
}

double force_at(const PlateLoad& load, double time_s) {
  const auto& times = load.time_s;
  if (times.size() < 2 || time_s < times.front() || time_s > times.back()) return 0.0;
  const auto after = std::upper_bound(times.begin(), times.end(), time_s);
  if (after == times.end()) return load.force_N.back();
  const auto k = static_cast<std::size_t>(after - times.begin());
  const double share = (time_s - times[k - 1]) / (times[k] - times[k - 1]);
  return load.force_N[k - 1] + share * (load.force_N[k] - load.force_N[k - 1]);
}

// Edges of the sum of all loads, interpolated between samples. Loads and gaps shorter
// than 30 ms are noise.
void find_plate_flights(JumpClip& clip) {
  if (clip.loads.empty()) return;
  constexpr double kMinGap_s = 0.03;
  const std::vector<double>& times = clip.loads[0].time_s;
  const double end_s = static_cast<double>(clip.frames() - 1) / clip.hz();
  double off_s = -1.0;
  double before = 0.0;
  bool has_before = false;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double excess = plate_force_N(clip, times[k]) - kLoaded_N;
    if (has_before && (before > 0.0) != (excess > 0.0)) {
      const double at_s =
          times[k - 1] + before / (before - excess) * (times[k] - times[k - 1]);
      if (excess <= 0.0) {
        off_s = at_s;
      } else {
        clip.plate_touchdowns_s.push_back(at_s);
        if (off_s >= 0.0 && at_s - off_s > kMinGap_s && at_s <= end_s) {
          clip.plate_flights.push_back({off_s, at_s});
        }
        off_s = -1.0;
      }
    }
    before = excess;
    has_before = true;
  }
}

ContactSource source_named(const std::string& name) {
  for (ContactSource& source : contact_sources()) {
    if (source.name == name) return std::move(source);
  }
  std::fprintf(stderr, "no recording is named %s\n", name.c_str());
  std::exit(1);
}

}  // namespace

double plate_force_N(const JumpClip& clip, double time_s) {
  double sum_N = 0.0;
  for (const PlateLoad& load : clip.loads) sum_N += force_at(load, time_s);
  return sum_N;
}

Result<JumpClip> jump_clip_of(std::string name, std::string kind, Motion motion) {
  auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  auto masses = retarget::place_masses(motion.skeleton, *map, {});
  if (!masses) return masses.error();
  JumpClip clip;
  clip.name = std::move(name);
  clip.kind = std::move(kind);
  clip.motion = std::move(motion);
  clip.map = *std::move(map);
  clip.masses = *std::move(masses);
  clip.track = retarget::body_track(clip.motion, clip.map, clip.masses);
  return clip;
}

Result<JumpClip> read_jump_clip(const std::filesystem::path& file,
                                const std::string& kind) {
  auto read = app::read_motion(file);
  if (!read) return read.error();
  return jump_clip_of(file.stem().string(), kind, std::move((*read).motion));
}

Result<JumpClip> read_plate_clip(const std::filesystem::path& mocap,
                                 const ContactSource& source) {
  auto trial = read_contact_trial(mocap, source);
  if (!trial) return trial.error();
  const auto clock = plate_clock(*trial);
  auto clip = jump_clip_of(source.name, source.kind, trial->motion);
  if (!clip) return clip.error();
  JumpClip& read = *clip;
  read.loads = trial->loads;
  if (clock) read.plate_delay_s = clock->delay_s;
  find_plate_flights(read);
  return clip;
}

std::vector<JumpClip> plate_clips(const std::filesystem::path& mocap) {
  std::vector<JumpClip> clips;
  for (const char* name : {"DJ1", "Rajagopal run", "Rajagopal walk", "Hamner run"}) {
    const ContactSource source = source_named(name);
    if (!std::filesystem::exists(mocap / source.markers)) continue;
    clips.push_back(or_stop(read_plate_clip(mocap, source)));
  }
  return clips;
}

std::optional<JumpClip> read_second_drop_jump(const std::filesystem::path& mocap) {
  ContactSource source = source_named("DJ1");
  std::swap(source.markers, source.support[0]);
  source.name = "DJ2";
  if (!std::filesystem::exists(mocap / source.markers)) return std::nullopt;
  JumpClip clip = or_stop(read_plate_clip(mocap, source));
  // The plates read are those of DJ1.
  clip.loads.clear();
  clip.plate_flights.clear();
  clip.plate_touchdowns_s.clear();
  clip.plate_delay_s.reset();
  return clip;
}

std::optional<JumpClip> read_rendered_jump(const std::filesystem::path& data) {
  auto motion = testing::truth_motion(
      (data / "blender/dev/jump/truth/segments_120hz.csv").string());
  if (!motion) return std::nullopt;
  return or_stop(jump_clip_of("rendered jump", "jump", *std::move(motion)));
}

std::vector<JumpClip> jump_clips(const std::filesystem::path& data) {
  std::vector<JumpClip> clips = plate_clips(data / "mocap");
  if (auto second = read_second_drop_jump(data / "mocap")) {
    clips.push_back(*std::move(second));
  }
  for (const auto& [file, kind] :
       {std::pair{"02_04.amc", "jump"}, {"02_03.amc", "run"}}) {
    const auto path = data / "mocap/cmu_asfamc" / file;
    if (std::filesystem::exists(path)) {
      clips.push_back(or_stop(read_jump_clip(path, kind)));
    }
  }
  if (auto rendered = read_rendered_jump(data)) clips.push_back(*std::move(rendered));
  return clips;
}

}  // namespace marey
