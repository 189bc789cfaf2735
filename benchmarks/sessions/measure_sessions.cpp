// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Assesses simulated sessions. docs/accuracy/README.md explains the table.
//
//   measure_sessions --seeds 0..99 [--threads 2] [--csv FILE]
//   measure_sessions --only SEED,SEED... [--verbose] [--joints FILE]
//   measure_sessions --sum FILE...
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <time.h>

#include "benchmarks/sessions/session_rows.h"
#include "core/base/parallel.h"
#include "tests/reconstruct/answer_session.h"
#include "tests/support/program/thread_time.h"

namespace marey::benchmarks {
namespace {

using testing::SessionAnswer;
using testing::SimulatedSession;

struct Options {
  std::vector<std::uint64_t> seeds;
  std::size_t threads = 1;
  bool is_verbose = false;
  bool is_simulation_only = false;
  std::string csv;
  std::string joints;  ///< File for one row per session, joint and source.
  std::vector<std::string> sum;
};

/// Prints the fitted body next to the true one.
void print_body(const SimulatedSession& session, const Body& found) {
  for (const HumanBone bone : human_bones()) {
    if (bone == HumanBone::kHips) continue;
    std::printf("  %-14s %.0f mm long (true %.0f), joint known to %.1f mm\n",
                std::string(name(bone)).c_str(),
                1e3 * glm::length(found.proportions[bone]),
                1e3 * glm::length(session.body.proportions[bone]),
                1e3 * found.joint_centre_sigma_m[index(bone)]);
  }
  for (const PlacedTag& tag : found.tags) {
    for (const testing::GluedTag& glued : session.tags) {
      if (glued.tag.id != tag.tag.id) continue;
      const glm::dvec3 p = tag.segment_from_tag.translation;
      const glm::dvec3 t = glued.segment_from_tag.translation;
      std::printf(
          "  tag %3d on %-14s %4.0f %4.0f %4.0f mm (true %4.0f %4.0f %4.0f), turned by "
          "%.0f deg, known to %.1f mm\n",
          number(tag.tag.id),
          std::string(name(tag.tag.segment)).c_str(),
          1e3 * p.x,
          1e3 * p.y,
          1e3 * p.z,
          1e3 * t.x,
          1e3 * t.y,
          1e3 * t.z,
          glm::degrees(
              glm::length(rotation_vector(glm::conjugate(tag.segment_from_tag.rotation) *
                                          glued.segment_from_tag.rotation))),
          1e3 * tag.sigma_m);
    }
  }
}

SessionRow measure(std::uint64_t seed, const Options& options) {
  const double start = testing::thread_time_s();
  const SimulatedSession session = testing::simulate_session(seed);
  const double simulated_s = testing::thread_time_s() - start;
  const testing::Sufficiency enough = testing::judge_sufficiency(session);
  SessionRow row;
  row.seed = seed;
  row.cameras = static_cast<int>(session.rig.cameras.size());
  row.session = session.summary();
  row.is_sufficient = enough.is_sufficient;
  row.lacking = enough.lacking;
  if (options.is_verbose) {
    std::printf("seed %llu: %s\n  simulated in %.2f s\n",
                static_cast<unsigned long long>(seed),
                row.session.c_str(),
                simulated_s);
    for (const auto& [joint, sigma_m] : enough.joint_sigma_m) {
      std::printf("  %-14s determined to %.1f mm\n",
                  std::string(name(joint)).c_str(),
                  1e3 * sigma_m);
    }
    std::printf(
        "  %s\n",
        enough.is_sufficient ? "sufficient" : ("lacks " + enough.lacking).c_str());
  }
  if (options.is_simulation_only) return row;
  const SessionAnswer answered = testing::answer_session(session);
  row.verdict = testing::judge(session, answered);
  for (const HumanBone segment : answered.left_out) {
    row.left_out += std::string(name(segment)) + " ";
  }
  for (const HumanBone bone : human_bones()) {
    row.fit_sigma_m[index(bone)] = answered.body.joint_centre_sigma_m[index(bone)];
  }
  row.fit_s = answered.fit_s;
  row.solve_s = answered.solve_s;
  if (answered.refusal) {
    row.refused_by = answered.refused_by;
    row.message_class = testing::message_class(*answered.refusal);
  }
  for (const testing::GrossJoint& gross : row.verdict.gross) {
    if (options.is_verbose) std::printf("  %s\n", gross.details.c_str());
    if (!gross.is_persistent) continue;
    row.causes += std::string(name(gross.joint)) + ":" + gross.cause + " ";
  }
  if (options.is_verbose) {
    if (!answered.refusal) print_body(session, answered.body);
    if (answered.refusal)
      std::printf("  refused: %s\n", answered.refusal->message().c_str());
    std::printf(
        "  joint centres: median %.1f, p95 %.1f, worst %.1f mm; fit %.1f s, "
        "motion %.1f s\n",
        1e3 * row.verdict.median_m,
        1e3 * row.verdict.p95_m,
        1e3 * row.verdict.max_m,
        row.fit_s,
        row.solve_s);
  }
  return row;
}

bool read_options(int argc, char** argv, Options& options) {
  std::vector<std::string> words(argv + 1, argv + argc);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool has_more = i + 1 < words.size();
    if (words[i] == "--verbose") {
      options.is_verbose = true;
    } else if (words[i] == "--simulate") {
      options.is_simulation_only = true;
    } else if (words[i] == "--seeds" && has_more) {
      const std::string& range = words[++i];
      const std::size_t dots = range.find("..");
      const std::uint64_t first = std::strtoull(range.c_str(), nullptr, 10);
      const std::uint64_t last =
          dots == std::string::npos
              ? first
              : std::strtoull(range.c_str() + dots + 2, nullptr, 10);
      for (std::uint64_t seed = first; seed <= last; ++seed)
        options.seeds.push_back(seed);
    } else if (words[i] == "--only" && has_more) {
      std::istringstream list(words[++i]);
      std::string seed;
      while (std::getline(list, seed, ',')) {
        options.seeds.push_back(std::strtoull(seed.c_str(), nullptr, 10));
      }
    } else if (words[i] == "--threads" && has_more) {
      options.threads = std::strtoull(words[++i].c_str(), nullptr, 10);
    } else if (words[i] == "--csv" && has_more) {
      options.csv = words[++i];
    } else if (words[i] == "--joints" && has_more) {
      options.joints = words[++i];
    } else if (words[i] == "--sum" && has_more) {
      options.sum.assign(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
      break;
    } else {
      return false;
    }
  }
  return !options.seeds.empty() || !options.sum.empty();
}

void write_joints(std::ostream& out, const SessionRow& row) {
  constexpr std::array<const char*, 3> kSourceNames{"measured", "repaired", "inferred"};
  for (const testing::JointFigures& joint : row.verdict.joints) {
    out << row.seed << ',' << name(joint.joint) << ','
        << kSourceNames[static_cast<std::size_t>(joint.source)] << ','
        << joint.honest.count << ',' << joint.honest.inside << ',' << joint.median_error_m
        << ',' << joint.median_sigma_m << ',' << row.fit_sigma_m[index(joint.joint)]
        << '\n';
  }
  out.flush();
}

int sum(const std::vector<std::string>& files) {
  std::vector<SessionRow> rows;
  std::set<std::uint64_t> seeds;
  for (const std::string& file : files) {
    std::ifstream in(file);
    auto more = read_rows(in);
    if (!more) {
      std::fprintf(stderr, "%s: not a table of measure_sessions\n", file.c_str());
      return 1;
    }
    for (const SessionRow& row : *more) {
      if (seeds.insert(row.seed).second) continue;
      std::fprintf(stderr,
                   "%s: session %llu is in it for the second time\n",
                   file.c_str(),
                   static_cast<unsigned long long>(row.seed));
      return 1;
    }
    rows.insert(rows.end(), more->begin(), more->end());
  }
  print_table(rows);
  return 0;
}

int run(const Options& options) {
  std::ofstream csv;
  if (!options.csv.empty()) {
    csv.open(options.csv);
    if (!csv) {
      std::fprintf(stderr, "%s: cannot be written\n", options.csv.c_str());
      return 1;
    }
    write_header(csv);
  }
  std::ofstream joints;
  if (!options.joints.empty()) {
    joints.open(options.joints);
    joints
        << "seed,joint,source,count,inside,median_error_m,median_sigma_m,fit_sigma_m\n";
  }
  std::vector<SessionRow> rows(options.seeds.size());
  std::mutex writing;
  in_parallel(rows.size(), options.threads, [&](std::size_t i) {
    rows[i] = measure(options.seeds[i], options);
    const std::lock_guard lock(writing);
    // An interrupted run keeps the rows that it has measured.
    if (csv) write_row(csv, rows[i]);
    if (joints) write_joints(joints, rows[i]);
  });
  for (SessionRow& row : rows) {
    // The same text as in the file, so that sums of files print the same.
    std::replace(row.session.begin(), row.session.end(), ',', ';');
  }
  if (!options.is_simulation_only) print_table(rows);
  return 0;
}

}  // namespace
}  // namespace marey::benchmarks

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  marey::benchmarks::Options options;
  if (!marey::benchmarks::read_options(argc, argv, options)) {
    std::fprintf(
        stderr,
        "usage: measure_sessions --seeds FIRST..LAST [--threads N] [--csv FILE]\n"
        "       measure_sessions --only SEED,SEED... [--verbose] [--simulate] "
        "[--joints FILE]\n"
        "       measure_sessions --sum FILE...\n");
    return 2;
  }
  return options.sum.empty() ? marey::benchmarks::run(options)
                             : marey::benchmarks::sum(options.sum);
}
