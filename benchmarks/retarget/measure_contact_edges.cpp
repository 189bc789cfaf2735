// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Errors of contact edges against force plates. Usage:
//   measure_contact_edges [MOCAP_FOLDER] [--all]
// --all prints every edge: errors of detect_contacts() and of find_contact_edges().
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/retarget/contact_trials.h"
#include "benchmarks/retarget/heel_rule.h"
#include "benchmarks/retarget/plate_clock.h"
#include "core/base/quantile.h"
#include "retarget/contacts/contact_edges.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey {
namespace {

// A found edge further than this from the plate's edge belongs to another step. [s]
constexpr double kSameStep_s = 0.15;

// Times of one kind of edge of one foot. [s]
std::vector<double> detected_times(const Contacts& contacts,
                                   const PlateEdge& edge,
                                   double hz) {
  std::vector<double> out;
  for (const FrameRange& run :
       contacts.feet[static_cast<std::size_t>(edge.side)].stance) {
    out.push_back((edge.is_strike ? run.first : run.last) / hz);
  }
  return out;
}

std::vector<double> found_times(const retarget::ContactEdges& edges,
                                const PlateEdge& edge) {
  std::vector<double> out;
  for (const auto& stance : edges.feet[static_cast<std::size_t>(edge.side)]) {
    const auto& one = edge.is_strike ? stance.strike : stance.toe_off;
    if (one) out.push_back(one->time_s);
  }
  return out;
}

std::optional<double> error_ms(const std::vector<double>& times, double truth_s) {
  std::optional<double> best;
  for (const double time_s : times) {
    const double error_s = time_s - truth_s;
    if (std::abs(error_s) > kSameStep_s) continue;
    if (!best || std::abs(error_s) < std::abs(*best)) best = error_s;
  }
  if (best) *best *= 1e3;
  return best;
}

struct EdgeErrors {
  int of = 0;  // Edges of the plates.
  std::vector<double> ms;

  void add(const EdgeErrors& more) {
    of += more.of;
    ms.insert(ms.end(), more.ms.begin(), more.ms.end());
  }
};

void print_errors(const std::string& name, const char* kind, const EdgeErrors& errors) {
  if (errors.of == 0) return;
  std::printf("%-22s %-9s %2zu/%2d", name.c_str(), kind, errors.ms.size(), errors.of);
  if (errors.ms.empty()) {
    std::printf("       -       -        -\n");
    return;
  }
  double mean = 0.0;
  std::vector<double> sizes;
  for (const double ms : errors.ms) {
    mean += ms / static_cast<double>(errors.ms.size());
    sizes.push_back(std::abs(ms));
  }
  double square = 0.0;
  for (const double ms : errors.ms) square += (ms - mean) * (ms - mean);
  const double sd = errors.ms.size() > 1
                        ? std::sqrt(square / static_cast<double>(errors.ms.size() - 1))
                        : 0.0;
  std::printf(
      "  %6.1f  %6.1f  %+6.1f +- %.1f\n", median(sizes), quantile(sizes, 0.9), mean, sd);
}

// Errors by rule and kind of edge ("strike", "toe-off"). Rules: "detect", "edges", and
// "clock", which are those of "edges" after correction of the plates' clock.
using ErrorTable = std::map<std::string, std::array<EdgeErrors, 2>>;

// Adds those of the design's rule for strikes, applied to the heel's marker ("marker")
// and to the same place of the fitted foot ("fitted").
void add_heel_errors(const ContactTrial& trial, ErrorTable& table) {
  const double hz = trial.motion.rate.hz;
  for (const PlateEdge& edge : trial.edges) {
    if (!edge.is_strike) continue;
    for (const auto& [rule, heights] :
         {std::pair("marker", marker_heights(trial, edge.side)),
          {"fitted", fitted_heights(trial, edge.side)}}) {
      if (heights.empty()) continue;
      EdgeErrors& errors = table[rule][0];
      ++errors.of;
      const auto found_s = strike_by_heel(heights, hz, edge.time_s);
      if (found_s) errors.ms.push_back(1e3 * (*found_s - edge.time_s));
    }
  }
}

ErrorTable measure(const ContactTrial& trial, bool prints_all) {
  const double hz = trial.motion.rate.hz;
  const auto contacts = retarget::detect_contacts(trial.motion, trial.map);
  const auto edges = retarget::find_contact_edges(trial.motion, trial.map);
  ErrorTable table;
  add_heel_errors(trial, table);
  const auto clock = plate_clock(trial);
  if (clock) {
    std::printf("  plates delayed by %+.0f ms, unexplained %.3f\n",
                1e3 * clock->delay_s,
                clock->unexplained_share);
  }
  for (const PlateEdge& edge : trial.edges) {
    const auto kind = static_cast<std::size_t>(edge.is_strike ? 0 : 1);
    const auto old_ms = error_ms(detected_times(contacts, edge, hz), edge.time_s);
    const auto new_ms = error_ms(found_times(edges, edge), edge.time_s);
    auto clock_ms = new_ms;
    if (clock && clock_ms) *clock_ms += 1e3 * clock->delay_s;
    for (const auto& [rule, ms] :
         {std::pair("detect", old_ms), {"edges", new_ms}, {"clock", clock_ms}}) {
      EdgeErrors& errors = table[rule][kind];
      ++errors.of;
      if (ms) errors.ms.push_back(*ms);
    }
    if (prints_all) {
      std::printf("  %8.4f s %s %-7s",
                  edge.time_s,
                  edge.side == 0 ? "left " : "right",
                  edge.is_strike ? "strike" : "toe-off");
      for (const auto& ms : {old_ms, new_ms}) {
        if (ms) {
          std::printf(" %+7.1f", *ms);
        } else {
          std::printf("       -");
        }
      }
      std::printf("\n");
    }
  }
  return table;
}

void print_table(const std::string& name, const ErrorTable& table) {
  for (const auto& [rule, errors] : table) {
    print_errors(name, (rule + " S").c_str(), errors[0]);
    print_errors(name, (rule + " T").c_str(), errors[1]);
  }
}

int measure_all(const std::filesystem::path& mocap, bool prints_all) {
  std::printf(
      "Errors against force plates (%.0f N), late is positive. S strike, T toe-off.\n"
      "%-22s %-9s %5s  median    90 %%    bias +- sd, ms\n",
      kLoaded_N,
      "recording",
      "rule",
      "n");
  std::map<std::string, ErrorTable> groups;
  for (const ContactSource& source : contact_sources()) {
    const auto trial = read_contact_trial(mocap, source);
    if (!trial) {
      std::printf("%-22s %s\n", source.name.c_str(), trial.error().message().c_str());
      continue;
    }
    const ErrorTable table = measure(*trial, prints_all);
    print_table(source.name + (source.is_tuned ? " *" : ""), table);
    const std::string group = source.kind + (source.is_tuned ? ", tuned" : ", others");
    for (const auto& [rule, errors] : table) {
      for (std::size_t k = 0; k < errors.size(); ++k)
        groups[group][rule][k].add(errors[k]);
    }
  }
  std::printf("\n");
  for (const auto& [group, table] : groups) print_table(group, table);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  std::filesystem::path mocap = "../shared/data/mocap";
  bool prints_all = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--all") == 0) {
      prints_all = true;
    } else {
      mocap = argv[i];
    }
  }
  return marey::measure_all(mocap, prints_all);
}
