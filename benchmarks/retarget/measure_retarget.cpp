// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Do standing feet stay in place on other bodies? This program retargets recorded motions
// to bodies of other proportions. It measures slide, drift, sinking and float of the
// points that touch the floor in the source, and the jerk relative to the source's.
// docs/accuracy/README.md describes how to run it.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"
#include "benchmarks/retarget/measure_spines.h"
#include "benchmarks/retarget/scaled_bodies.h"
#include "core/pose.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/motion/live_retarget.h"
#include "retarget/motion/retarget_motion.h"

namespace marey {
namespace {

constexpr std::array kBodies{
    BodyScale{"same", 1.0, 1.0, 1.0},
    BodyScale{"child 0.7", 0.7, 0.7, 0.7},
    BodyScale{"legs 1.2, trunk 0.9", 1.2, 0.9, 1.0},
    BodyScale{"legs 0.75, trunk 1.15", 0.75, 1.15, 1.0},
};

/// A whole motion at once, or posture by posture.
enum class Way { kOffline, kLive };

Result<Motion> retargeted(const Motion& source, const Skeleton& body, Way way) {
  if (way == Way::kOffline) {
    auto whole = retarget::retarget_motion(source, body);
    if (!whole) return whole.error();
    return std::move(whole->motion);
  }
  auto live = retarget::LiveRetarget::make(source.skeleton, body);
  if (!live) return live.error();
  Motion out{body, source.rate, source.first_frame, {}};
  out.poses.resize(source.poses.size());
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    live->step(source.poses[t], 1.0 / source.rate.hz, out.poses[t]);
  }
  return out;
}

Status add_row(const CapturedClip& clip,
               const BodyScale& scale,
               Way way,
               ResultTable& table) {
  const Motion source{clip.character.skeleton, {clip.rate_hz}, 0, clip.poses};
  const Skeleton body = scaled(source.skeleton, scale);
  const auto bodies = retarget::map_bodies(
      source.skeleton, body, retarget::RootNormalization::kLegLength);
  if (!bodies) return bodies.error();
  const auto begin = std::chrono::steady_clock::now();
  const auto motion = retargeted(source, body, way);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  if (!motion) return motion.error();
  const retarget::ContactLabels labels = retarget::label_contacts(
      retarget::contact_paths(source, bodies->source), clip.rate_hz);
  const retarget::ContactFigures figures =
      retarget::measure_contacts(retarget::contact_paths(*motion, bodies->avatar),
                                 labels,
                                 retarget::rest_heights_m(bodies->avatar),
                                 clip.rate_hz);
  const double height_ratio = retarget::head_height_m(body, bodies->avatar) /
                              retarget::head_height_m(source.skeleton, bodies->source);
  table.rows.push_back(
      {clip.name,
       scale.name,
       figures.mean_slide_cm_per_s,
       figures.median_drift_mm,
       figures.worst_drift_mm,
       figures.sinking_mm,
       figures.float_mm,
       static_cast<double>(figures.floating_frames),
       retarget::mean_jerk(*motion) / (height_ratio * retarget::mean_jerk(source)),
       1e6 * took.count() / static_cast<double>(clip.poses.size())});
  return Done{};
}

ResultTable empty_table(const char* id, const char* title) {
  return {id,
          title,
          {{"clip"},
           {"body"},
           {"slide cm/s", 3},
           {"median drift mm", 2},
           {"worst drift mm", 2},
           {"sinking mm", 2},
           {"float mm", 1},
           {"frames > 5 mm", 0},
           {"jerk / source's", 3},
           {"us/frame", 1}},
          {},
          {}};
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s: %s\n", error.where.c_str(), error.cause.c_str());
  return 3;
}

int run(const std::filesystem::path& mocap, const std::filesystem::path& json) {
  const auto clips = read_clips(mocap, ClipSet::kAll);
  if (!clips) return fail(clips.error());
  std::vector<ResultTable> tables{
      empty_table("offline", "Recorded motions on other bodies, whole"),
      empty_table("live", "The same posture by posture, without the future")};
  for (const CapturedClip& clip : *clips) {
    for (const BodyScale& scale : kBodies) {
      for (const Way way : {Way::kOffline, Way::kLive}) {
        ResultTable& table = tables[way == Way::kLive ? 1 : 0];
        if (const Status ok = add_row(clip, scale, way, table); !ok) {
          return fail(ok.error());
        }
      }
    }
  }
  auto spines = measure_spines(*clips);
  if (!spines) return fail(spines.error());
  tables.push_back(std::move(*spines));
  for (const ResultTable& table : tables) print_table(table);
  if (json.empty()) return 0;
  return write_tables(json, tables) ? 0 : 5;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_retarget MOCAP_FOLDER [FIGURES.json]\n");
    return 2;
  }
  return marey::run(argv[1], argc > 2 ? argv[2] : "");
}
