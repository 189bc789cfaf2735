// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Does a body of other proportions or other masses stay over its feet where the source
// does? This program retargets recorded motions with and without balance. It measures the
// share of frames with support in which the centre of mass is above the support, the
// number of frames that lose this, and the cost in slide, drift, jerk and time.
// docs/accuracy/README.md describes how to run it.
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"
#include "benchmarks/retarget/scaled_bodies.h"
#include "retarget/body/anthropometry.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/motion/retarget_motion.h"

namespace marey {
namespace {

struct Body {
  BodyScale scale;
  double trunk_mass = 1.0;  ///< Factor of the table's mass.
};

constexpr std::array kBodies{
    Body{{"same", 1.0, 1.0, 1.0}},
    Body{{"child 0.7", 0.7, 0.7, 0.7}},
    Body{{"legs 1.2, trunk 0.9", 1.2, 0.9, 1.0}},
    Body{{"legs 0.75, trunk 1.15", 0.75, 1.15, 1.0}},
    Body{{"trunk 1.5", 1.0, 1.5, 1.0}},
    Body{{"trunk twice as heavy", 1.0, 1.0, 1.0}, 2.0},
    Body{{"trunk 1.5, twice as heavy", 1.0, 1.5, 1.0}, 2.0},
};

MassSpec masses_of(const Body& body) {
  constexpr double kTotal_kg = 70.0;
  MassSpec out;
  const double trunk_kg = kTotal_kg * retarget::segment_table(out.table).trunk.mass_share;
  out.total_kg = kTotal_kg + (body.trunk_mass - 1.0) * trunk_kg;
  out.segment_kg[index(HumanBone::kHips)] = body.trunk_mass * trunk_kg;
  return out;
}

/// Contact figures and jerk of a result, relative to the source.
struct Cost {
  retarget::ContactFigures contacts;
  double jerk = 0.0;
};

Cost cost_of(const Motion& source,
             const retarget::MappedBodies& maps,
             const Motion& made) {
  const auto labels = retarget::label_contacts(
      retarget::contact_paths(source, maps.source), source.rate.hz);
  const double height_ratio = retarget::head_height_m(made.skeleton, maps.avatar) /
                              retarget::head_height_m(source.skeleton, maps.source);
  return {retarget::measure_contacts(retarget::contact_paths(made, maps.avatar),
                                     labels,
                                     retarget::rest_heights_m(maps.avatar),
                                     source.rate.hz),
          retarget::mean_jerk(made) / (height_ratio * retarget::mean_jerk(source))};
}

Status add_row(const CapturedClip& clip, const Body& body, ResultTable& table) {
  const Motion source{clip.character.skeleton, {clip.rate_hz}, 0, clip.poses};
  const Skeleton avatar = scaled(source.skeleton, body.scale);
  const auto maps = retarget::map_bodies(
      source.skeleton, avatar, retarget::RootNormalization::kLegLength);
  if (!maps) return maps.error();
  retarget::RetargetOptions options;
  const auto without = retarget::retarget_motion(source, avatar, options);
  if (!without) return without.error();
  options.balance.emplace().avatar_masses = masses_of(body);
  const auto begin = std::chrono::steady_clock::now();
  const auto with = retarget::retarget_motion(source, avatar, options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  if (!with) return with.error();
  const Cost before = cost_of(source, *maps, without->motion);
  const Cost after = cost_of(source, *maps, with->motion);
  const retarget::BalanceReport& report = *with->report.balance;
  table.rows.push_back({clip.name,
                        body.scale.name,
                        100.0 * report.source.over_share(),
                        100.0 * report.before.over_share(),
                        100.0 * report.after.over_share(),
                        static_cast<double>(report.before.lost_frames),
                        static_cast<double>(report.after.lost_frames),
                        1e3 * report.kept.mean_off_before_m,
                        1e3 * report.kept.mean_off_m,
                        100.0 * report.kept.max_shift_m,
                        before.contacts.mean_slide_cm_per_s,
                        after.contacts.mean_slide_cm_per_s,
                        before.contacts.worst_drift_mm,
                        after.contacts.worst_drift_mm,
                        before.jerk,
                        after.jerk,
                        static_cast<double>(with->report.ground.unreachable_frames),
                        1e6 * took.count() / static_cast<double>(clip.poses.size())});
  return Done{};
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s: %s\n", error.where.c_str(), error.cause.c_str());
  return 3;
}

int run(const std::filesystem::path& mocap, const std::filesystem::path& json) {
  const auto clips = read_clips(mocap, ClipSet::kAll);
  if (!clips) return fail(clips.error());
  ResultTable table{"balance",
                    "Centre of mass over its support, without and with balance",
                    {{"clip"},
                     {"body"},
                     {"source %", 1},
                     {"without %", 1},
                     {"with %", 1},
                     {"lost without", 0},
                     {"lost with", 0},
                     {"off without", 1},
                     {"off with mm", 1},
                     {"root moved cm", 1},
                     {"slide without", 3},
                     {"with cm/s", 3},
                     {"drift without", 2},
                     {"with mm", 2},
                     {"jerk without", 3},
                     {"with", 3},
                     {"unreached", 0},
                     {"us/frame", 1}},
                    {},
                    {}};
  for (const CapturedClip& clip : *clips) {
    for (const Body& body : kBodies) {
      if (const Status ok = add_row(clip, body, table); !ok) return fail(ok.error());
    }
  }
  print_table(table);
  if (json.empty()) return 0;
  return write_tables(json, {table}) ? 0 : 5;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_retarget_balance MOCAP_FOLDER [FIGURES.json]\n");
    return 2;
  }
  return marey::run(argv[1], argc > 2 ? argv[2] : "");
}
