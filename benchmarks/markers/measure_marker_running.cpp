// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/markers/marker_subject.h"

namespace marey {
namespace {

constexpr const char* kX = "_tx";

/// Returns the markers of the other program's result, without the suffix of its columns.
std::vector<std::string> compared_labels(const recordings::MotTable& theirs) {
  std::vector<std::string> out;
  for (const auto& column : theirs.columns) {
    if (column.name.ends_with(kX)) {
      out.push_back(column.name.substr(0, column.name.size() - 3));
    }
  }
  return out;
}

/// Computes the distances of the other program's markers from the measured ones.
Distances their_distances(const recordings::MotTable& theirs,
                          const MarkerTracks& tracks,
                          const std::vector<std::string>& labels) {
  Distances out;
  for (const std::string& label : labels) {
    const std::size_t x = *theirs.find(label + kX);
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      if (tracks.labels[m] != label) continue;
      for (std::size_t f = 0; f < std::min(tracks.frames(), theirs.rows()); ++f) {
        const auto& sample = tracks.at(f, m);
        if (!sample) continue;
        const glm::dvec3 p(theirs.at(f, x), theirs.at(f, x + 1), theirs.at(f, x + 2));
        out.add(glm::distance(p, sample->p_in_world));
      }
    }
  }
  return out;
}

/// Computes the distances of one marker of the body from its measured positions.
Distances distances(const reconstruct::SolvedMarkers& solved,
                    const Body& body,
                    std::size_t marker,
                    const MarkerTracks& tracks) {
  Distances out;
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    if (tracks.labels[m] != body.markers[marker].label) continue;
    for (std::size_t f = 0; f < tracks.frames(); ++f) {
      const auto& sample = tracks.at(f, m);
      if (!sample) continue;
      const auto& modelled = solved.modelled_in_world[f * body.markers.size() + marker];
      out.add(glm::distance(modelled, sample->p_in_world));
    }
  }
  return out;
}

MarkerTracks without(const MarkerTracks& tracks, const std::string& label) {
  MarkerTracks out = tracks;
  for (std::size_t m = 0; m < out.markers(); ++m) {
    if (out.labels[m] != label) continue;
    for (std::size_t f = 0; f < out.frames(); ++f) out.at(f, m).reset();
  }
  return out;
}

std::optional<std::size_t> find(const Body& body, const std::string& label) {
  for (std::size_t i = 0; i < body.markers.size(); ++i) {
    if (body.markers[i].label == label) return i;
  }
  return std::nullopt;
}

void print(const char* what, const Distances& d) {
  if (d.empty()) return;
  std::printf("%-44s %7zu  rms %5.1f  mean %5.1f  p95 %5.1f  max %5.1f mm\n",
              what,
              d.size(),
              d.rms_mm(),
              d.mean_mm(),
              d.quantile_mm(0.95),
              d.quantile_mm(1.0));
}

Distances used(const Body& body,
               const MarkerTracks& running,
               const std::vector<std::string>& labels) {
  const auto solved = solve(body, running);
  Distances all;
  for (const std::string& label : labels) {
    if (const auto marker = find(body, label)) {
      all.add(distances(solved, body, *marker, running));
    } else {
      std::printf("  %s is left out of the body\n", label.c_str());
    }
  }
  return all;
}

/// Withholds every marker in turn from the solver.
Distances held_out(const Body& body,
                   const MarkerTracks& running,
                   const std::vector<std::string>& labels,
                   std::map<std::string, double>& rms_mm) {
  Distances all;
  for (const std::string& label : labels) {
    const auto marker = find(body, label);
    if (!marker) continue;
    const auto solved = solve(body, without(running, label));
    const Distances one = distances(solved, body, *marker, running);
    if (one.empty()) continue;
    rms_mm[label] = one.rms_mm();
    all.add(one);
  }
  return all;
}

/// Withholds every marker also from the fit's running trial, so that its position on the
/// body comes from the static trial. Withholds several markers at a time, because a fit
/// takes seconds. No two of them are neighbours in the list.
Distances refitted(const std::vector<MarkerTracks>& trials,
                   const std::vector<std::string>& labels) {
  constexpr std::size_t kGroups = 9;
  Distances all;
  for (std::size_t group = 0; group < kGroups; ++group) {
    std::vector<MarkerTracks> holed = trials;
    for (std::size_t i = group; i < labels.size(); i += kGroups) {
      holed.back() = without(holed.back(), labels[i]);
    }
    const Body body = fit_person(holed).body;
    const auto solved = solve(body, holed.back());
    for (std::size_t i = group; i < labels.size(); i += kGroups) {
      if (const auto marker = find(body, labels[i])) {
        all.add(distances(solved, body, *marker, trials.back()));
      }
    }
  }
  return all;
}

}  // namespace

int measure_running(const std::filesystem::path& mocap) {
  const auto hamner = mocap / "opensim-models/Hamner";
  const std::vector<std::filesystem::path> files{hamner / "subject02_static.trc",
                                                 hamner / "subject02_running.trc"};
  const auto theirs = recordings::read_mot(
      hamner / "outputReference/ResultsIK/ik_model_marker_locations.sto");
  if (!theirs) stop(theirs.error().message());
  const auto labels = compared_labels(*theirs);
  const MarkerPerson person = read_person(files);
  const MarkerTracks& running = person.trials.back();
  std::printf("%zu markers, %zu frames; bodies with bones of fixed lengths\n",
              labels.size(),
              running.frames());
  print("OpenSim's model", their_distances(*theirs, running, labels));
  print("marey, fitted from both trials", used(person.fit.body, running, labels));
  const Body still = fit_person(std::span(person.trials).first(1)).body;
  print("marey, fitted from standing still", used(still, running, labels));
  std::map<std::string, double> both_mm;
  std::map<std::string, double> still_mm;
  print("held out, place from both trials",
        held_out(person.fit.body, running, labels, both_mm));
  print("held out in groups, place from standing still", refitted(person.trials, labels));
  print("held out, body and place from standing still",
        held_out(still, running, labels, still_mm));
  std::printf("held out, rms mm (both trials, standing still):\n");
  for (const auto& [label, mm] : both_mm) {
    std::printf("  %-14s %5.1f %5.1f\n", label.c_str(), mm, still_mm[label]);
  }
  return 0;
}

}  // namespace marey
