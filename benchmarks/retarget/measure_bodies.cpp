// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Are results on bodies from other sources correct? The cases are generated bodies by
// seed and real ones, each with every clip. Independent code, which shares nothing with
// the program, checks the results. docs/accuracy/README.md describes how to run it.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/bodies/body_campaign.h"
#include "tests/support/files/floor_clip.h"

namespace marey::testing {
namespace {

/// A segment whose median angle to the source's is larger is listed. [deg]
constexpr double kBar_deg = 8.0;

std::string one_line(const std::string& text) {
  return text.substr(0, std::min<std::size_t>(text.find('\n'), 150));
}

void print(const CampaignResult& r) {
  std::string errors;
  for (const std::string& error : gross_errors(r)) errors += " [" + error + "]";
  if (!r.judged) {
    std::printf("%-22s %-30s refused: %s\n",
                r.body.c_str(),
                r.clip.c_str(),
                one_line(r.error).c_str());
    return;
  }
  const BodyFigures& j = *r.judged;
  std::printf(
      "%-22s %-30s skin %7.1f mm (reported %7.1f, source %5.1f) at %4d %-18s trunk %5.1f "
      "segment %5.1f/%5.1f %-14s feet %5.1f (reported %5.1f) at %4d heading %6.1f speed "
      "%5.1f/%5.1f%s%s\n",
      r.body.c_str(),
      r.clip.c_str(),
      j.skin_depth_mm,
      r.reported_depth_mm.value_or(-1.0),
      j.source_depth_mm,
      j.skin_frame,
      j.skin_node.c_str(),
      j.trunk_median_deg,
      j.worst_median_deg,
      j.worst_p95_deg,
      j.worst_segment.c_str(),
      j.foot_yaw_deg,
      r.reported_foot_deg.value_or(-1.0),
      j.foot_yaw_frame,
      j.heading_deg,
      j.max_speed,
      j.source_max_speed,
      errors.c_str(),
      r.reported_problems.empty()
          ? ""
          : (" REPORTED: " + r.reported_problems.front()).c_str());
  for (const auto& [segment, median_deg] : j.medians_deg) {
    if (median_deg > kBar_deg) std::printf("    %s %.1f", segment.c_str(), median_deg);
  }
  std::printf("\n");
}

struct Tally {
  int cases = 0, refused = 0, wrong = 0, silent = 0;
  std::map<std::string, int> causes;
  std::map<std::string, int> beyond;  ///< Results by segment beyond kBar_deg.
  int directions = 0;                 ///< Segments of all results.
  std::map<std::string, int> refusals;

  void add(const CampaignResult& r) {
    ++cases;
    if (!r.judged) {
      ++refused;
      const std::size_t colon = r.error.find(": ");
      ++refusals[one_line(colon == std::string::npos ? r.error
                                                     : r.error.substr(colon + 2))];
      return;
    }
    for (const auto& [segment, median_deg] : r.judged->medians_deg) {
      ++directions;
      if (median_deg > kBar_deg) ++beyond[segment];
    }
    const auto errors = gross_errors(r);
    for (const std::string& error : errors) ++causes[error];
    if (errors.empty()) return;
    ++wrong;
    if (r.reported_problems.empty()) ++silent;
  }
  void print() const {
    std::printf("\n%d results: %d refused, %d wrong, %d of them silently\n",
                cases,
                refused,
                wrong,
                silent);
    for (const auto& [cause, count] : causes)
      std::printf("%5d  %s\n", count, cause.c_str());
    std::printf("%d directions, medians beyond %.0f degrees:\n", directions, kBar_deg);
    for (const auto& [segment, count] : beyond)
      std::printf("%5d  %s\n", count, segment.c_str());
    for (const auto& [cause, count] : refusals) {
      std::printf("%5d  refused: %s\n", count, cause.c_str());
    }
  }
};

std::vector<CampaignBody> real_bodies(const std::filesystem::path& root) {
  std::vector<CampaignBody> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const auto kind = entry.path().extension();
    if (kind != ".glb" && kind != ".vrm") continue;
    try {
      PosedGlb glb(entry.path());
      out.push_back({entry.path(), bone_nodes(glb.node_names()), "real"});
    } catch (const std::exception&) {
      std::printf("%s has no skin that the judge reads\n", entry.path().c_str());
    }
  }
  return out;
}

int run(const std::vector<std::string>& args) {
  // The program runs in separate folders, so the paths are absolute.
  const auto folder = std::filesystem::absolute(args[2]);
  const auto program = std::filesystem::absolute(args[1]);
  std::filesystem::create_directories(folder);
  std::vector<CampaignBody> bodies;
  const int count = std::atoi(args[4].c_str());
  if (count > 0)
    bodies = made_bodies(folder, std::strtoull(args[3].c_str(), nullptr, 10), count);
  if (args[5] != "-") {
    for (CampaignBody& body : real_bodies(std::filesystem::absolute(args[5])))
      bodies.push_back(std::move(body));
  }
  for (const CampaignBody& body : bodies) {
    std::printf("%-22s %s\n", body.path.stem().c_str(), body.words.c_str());
  }
  Tally tally;
  for (std::size_t i = 6; i < args.size(); ++i) {
    std::filesystem::path clip = std::filesystem::absolute(args[i]);
    if (args[i] == "floor") {
      clip = folder / "floor.bvh";
      write_floor_clip(clip);
    }
    for (const CampaignResult& r : run_campaign(program, folder, clip, bodies)) {
      print(r);
      std::fflush(stdout);
      tally.add(r);
    }
  }
  tally.print();
  return tally.silent == 0 ? 0 : 4;
}

}  // namespace
}  // namespace marey::testing

int main(int argc, char** argv) {
  if (argc < 7) {
    std::fprintf(
        stderr,
        "usage: measure_bodies MAREY FOLDER FIRST_SEED COUNT AVATARS|- CLIP|floor...\n");
    return 2;
  }
  try {
    return marey::testing::run({argv, argv + argc});
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
  }
}
