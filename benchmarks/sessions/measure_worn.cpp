// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Counts exchanged segments that are detected, and false alarms.
//
//   measure_worn FIRST LAST
//   measure_worn --tags FIRST LAST
//
// simulates the sessions of these seeds (tests/support/simulation/simulated_session.h)
// and runs find_suspect_tags() on each, as it is and with exchanges of segments.
// "reported": an error. "named": it names the exchanged segments or limbs. With --tags
// one tag of a segment with several is declared on another segment instead, and
// fit_subject() is run. Then "named" is an error or a finding that names the tag or one
// of the two segments, or a fit that leaves the tag out.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/human/average_proportions.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/segments/find_suspect_tags.h"
#include "reconstruct/subject/fit_subject.h"
#include "tests/support/simulation/simulated_session.h"

namespace {

using marey::HumanBone;
using marey::mirrored;
using marey::TagOnSegment;
using B = HumanBone;

struct Exchange {
  std::string name;
  std::function<B(B)> declared;
  std::vector<std::string> words;  ///< A message that names it has one of them.
};

std::function<B(B)> sides_of(std::vector<B> left) {
  return [left](B bone) {
    const bool is_meant = std::count(left.begin(), left.end(), bone) +
                              std::count(left.begin(), left.end(), mirrored(bone)) >
                          0;
    return is_meant ? mirrored(bone) : bone;
  };
}

std::vector<Exchange> exchanges() {
  std::vector<Exchange> out;
  out.push_back({"right", [](B bone) { return bone; }, {}});
  out.push_back({"sides", [](B bone) { return mirrored(bone); }, {"arms and legs"}});
  out.push_back({"arms",
                 sides_of({B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand}),
                 {"on the arms"}});
  out.push_back({"legs",
                 sides_of({B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot}),
                 {"on the legs"}});
  for (const B left : {B::kLeftUpperArm,
                       B::kLeftLowerArm,
                       B::kLeftHand,
                       B::kLeftUpperLeg,
                       B::kLeftLowerLeg,
                       B::kLeftFoot}) {
    out.push_back({std::string(name(left)), sides_of({left}), {std::string(name(left))}});
  }
  out.push_back({"hips-chest",
                 [](B bone) {
                   return bone == B::kHips         ? B::kUpperChest
                          : bone == B::kUpperChest ? B::kHips
                                                   : bone;
                 },
                 {"\"hips\" and \"upperChest\""}});
  return out;
}

/// Runs find_suspect_tags() on a session. SuspectTags count as an error here, although
/// fit_subject() may refute it.
marey::Status check(const marey::testing::SimulatedSession& session,
                    const std::vector<TagOnSegment>& tags) {
  using namespace marey::reconstruct;
  const std::vector<marey::Camera>& cameras = session.rig.cameras;
  const std::array<Sightings, 2> trials{
      group_sightings(session.standing.detections, tags),
      group_sightings(session.moving.detections, tags)};
  const auto clusters = cluster_tags(cameras, tags, trials);
  std::array<std::vector<ClusterPoses>, 2> located;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const std::size_t step = 1 + trials[t].frames.size() / 300;
    for (std::size_t f = 0; f < trials[t].frames.size(); f += step) {
      ClusterPoses& poses = located[t].emplace_back();
      for (const TagCluster& cluster : clusters) {
        const auto pose = locate_cluster(cluster, cameras, tags, trials[t].frames[f]);
        if (pose) poses[cluster.segment] = *pose;
      }
    }
  }
  const auto worn =
      find_suspect_tags({cameras, tags, trials, clusters, located[0], located[1]},
                        marey::average_proportions(session.body.declared_stature_m));
  if (!worn) return worn.error();
  if (*worn) return (*worn)->error;
  return marey::Done{};
}

/// One tag of a segment with several, declared on another segment; drawn by the seed.
struct Misdeclared {
  std::size_t tag = 0;
  B segment{};
};

Misdeclared misdeclared(const std::vector<TagOnSegment>& tags, int seed) {
  std::mt19937 dice(static_cast<std::mt19937::result_type>(seed));
  std::vector<std::size_t> several;
  std::vector<B> segments;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const auto same = [&](const TagOnSegment& t) { return t.segment == tags[i].segment; };
    if (std::count_if(tags.begin(), tags.end(), same) > 1) several.push_back(i);
    if (std::count(segments.begin(), segments.end(), tags[i].segment) == 0) {
      segments.push_back(tags[i].segment);
    }
  }
  if (several.empty()) return {tags.size(), {}};
  const std::size_t tag = several[dice() % several.size()];
  std::erase(segments, tags[tag].segment);
  return {tag, segments[dice() % segments.size()]};
}

int measure_single_tags(int first, int last) {
  int made = 0;
  int reported = 0;
  int named = 0;
  for (int seed = first; seed <= last; ++seed) {
    const auto session =
        marey::testing::simulate_session(static_cast<std::uint64_t>(seed));
    std::vector<TagOnSegment> tags = session.declared_tags();
    const Misdeclared change = misdeclared(tags, seed);
    if (change.tag == tags.size()) continue;
    const auto fit_with = [&](const std::vector<TagOnSegment>& declared) {
      return marey::reconstruct::fit_subject(
          {"someone", session.body.declared_stature_m, {}, declared},
          session.rig.cameras,
          session.standing.detections,
          session.moving.detections);
    };
    // A session that is refused without the mistake is not usable.
    const auto right = fit_with(tags);
    if (!right || !right->findings.empty()) continue;
    const B worn = tags[change.tag].segment;
    tags[change.tag].segment = change.segment;
    ++made;
    std::string words;
    const auto fit = fit_with(tags);
    if (!fit) words = fit.error().message();
    for (std::size_t i = 0; fit && i < fit->findings.size(); ++i) {
      words += fit->findings[i].message() + "\n";
    }
    // The program warns of tags that are left out.
    const TagOnSegment& changed = tags[change.tag];
    const bool is_left_out =
        fit && std::count(fit->unplaced.begin(), fit->unplaced.end(), changed.id) > 0;
    if (is_left_out) words += "tag " + std::to_string(number(changed.id)) + " left out";
    reported += words.empty() ? 0 : 1;
    const bool is_named =
        words.find("tag " + std::to_string(number(tags[change.tag].id)) + " ") !=
            std::string::npos ||
        words.find(name(worn)) != std::string::npos ||
        words.find(name(change.segment)) != std::string::npos;
    named += is_named ? 1 : 0;
    if (is_named) continue;
    std::printf("seed %d, tag %d of %s declared on %s: %s\n",
                seed,
                number(tags[change.tag].id),
                std::string(name(worn)).c_str(),
                std::string(name(change.segment)).c_str(),
                words.empty() ? "nothing is reported" : words.c_str());
    std::fflush(stdout);
  }
  std::printf("%d made, %d reported, %d named\n", made, reported, named);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--tags") {
    return measure_single_tags(std::atoi(argv[2]), std::atoi(argv[3]));
  }
  if (argc != 3) {
    std::fprintf(stderr, "usage: measure_worn [--tags] FIRST LAST\n");
    return 2;
  }
  std::map<std::string, std::array<int, 3>> counts;  // Made, reported, named.
  for (int seed = std::atoi(argv[1]); seed <= std::atoi(argv[2]); ++seed) {
    const auto session =
        marey::testing::simulate_session(static_cast<std::uint64_t>(seed));
    for (const Exchange& exchange : exchanges()) {
      std::vector<TagOnSegment> tags = session.declared_tags();
      for (TagOnSegment& tag : tags) tag.segment = exchange.declared(tag.segment);
      const marey::Status ok = check(session, tags);
      auto& [made, reported, named] = counts[exchange.name];
      ++made;
      if (ok) continue;
      ++reported;
      const std::string error = ok.error().message();
      const bool is_named = std::any_of(
          exchange.words.begin(), exchange.words.end(), [&](const std::string& word) {
            return error.find(word) != std::string::npos;
          });
      if (is_named) ++named;
      if (!is_named) {
        std::printf("seed %d, %s: %s\n", seed, exchange.name.c_str(), error.c_str());
        std::fflush(stdout);
      }
    }
  }
  std::printf("%-16s %6s %8s %6s\n", "exchanged", "made", "reported", "named");
  for (const auto& [name, count] : counts) {
    std::printf("%-16s %6d %8d %6d\n", name.c_str(), count[0], count[1], count[2]);
  }
  return 0;
}
