// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the repair of a file's own gaps, whose truth is unknown: the changes of the
// distances on rigid bones, and the steps from frame to frame. docs/accuracy/README.md
// describes how to run it.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "reconstruct/tracks/find_marker_faults.h"
#include "reconstruct/tracks/repair_gaps.h"
#include "recordings/markers/marker_file.h"

namespace {

using namespace marey;

double quantile_of(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

bool is_measured(const std::optional<MarkerSample>& sample) {
  return sample && sample->source == Source::kMeasured;
}

/// Compares repaired with measured distances of two markers on one bone. Two markers
/// count as on one bone if their measured distance has a standard deviation of at most 2
/// % and 5 mm, and a median of at least 0.05 m, so that a percentage is meaningful.
void measure_bones(const MarkerTracks& tracks) {
  std::vector<double> off;
  std::vector<double> measured_off;
  std::size_t bones = 0;
  for (std::size_t a = 0; a < tracks.markers(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::vector<double> lengths;
      for (std::size_t f = 0; f < tracks.frames(); ++f) {
        if (!is_measured(tracks.at(f, a)) || !is_measured(tracks.at(f, b))) continue;
        lengths.push_back(
            glm::distance(tracks.at(f, a)->p_in_world, tracks.at(f, b)->p_in_world));
      }
      if (lengths.size() < 100) continue;
      const double length = median(lengths);
      double squares = 0.0;
      for (const double l : lengths) squares += (l - length) * (l - length);
      const double spread = std::sqrt(squares / static_cast<double>(lengths.size()));
      if (length < 0.05 || spread > std::min(0.005, 0.02 * length)) continue;
      ++bones;
      for (const double l : lengths) measured_off.push_back(std::abs(l / length - 1.0));
      for (std::size_t f = 0; f < tracks.frames(); ++f) {
        const auto& p = tracks.at(f, a);
        const auto& q = tracks.at(f, b);
        if (!p || !q || (is_measured(p) && is_measured(q))) continue;
        off.push_back(
            std::abs(glm::distance(p->p_in_world, q->p_in_world) / length - 1.0));
      }
    }
  }
  const auto within =
      std::count_if(off.begin(), off.end(), [](double o) { return o <= 0.03; });
  std::printf("%zu steady distances; off their medians: measured p95 %.1f %%\n",
              bones,
              100.0 * quantile_of(measured_off, 0.95));
  std::printf("repaired, %zu samples: within 3 %% %.1f %%, median %.1f %%, p95 %.1f %%\n",
              off.size(),
              off.empty()
                  ? 100.0
                  : 100.0 * static_cast<double>(within) / static_cast<double>(off.size()),
              100.0 * quantile_of(off, 0.5),
              100.0 * quantile_of(off, 0.95));
}

void measure_steps(const MarkerTracks& tracks) {
  std::vector<double> measured;
  std::vector<double> edges;
  std::vector<double> inside;
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    for (std::size_t f = 0; f + 1 < tracks.frames(); ++f) {
      const auto& a = tracks.at(f, m);
      const auto& b = tracks.at(f + 1, m);
      if (!a || !b) continue;
      const double step = glm::distance(a->p_in_world, b->p_in_world);
      const int known = is_measured(a) + is_measured(b);
      (known == 2 ? measured : known == 1 ? edges : inside).push_back(step);
    }
  }
  const auto print_row = [](const char* what, std::vector<double>& steps) {
    const double median_m = quantile_of(steps, 0.5);
    const double p99_m = quantile_of(steps, 0.99);
    std::printf(
        "steps from frame to frame, %s: %zu, median %.1f, 99 %% %.1f, largest "
        "%.1f mm\n",
        what,
        steps.size(),
        1e3 * median_m,
        1e3 * p99_m,
        1e3 * quantile_of(steps, 1.0));
  };
  print_row("measured", measured);
  print_row("at a gap's edge", edges);
  print_row("within gaps", inside);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: measure_repair FILE.(c3d|trc)\n");
    return 2;
  }
  const auto file = recordings::read_markers(argv[1]);
  if (!file) {
    std::fprintf(stderr, "%s: %s\n", argv[1], file.error().cause.c_str());
    return 3;
  }
  const auto checked = reconstruct::find_marker_faults(file->tracks);
  const auto repaired = reconstruct::repair_gaps(checked.tracks);
  const auto empty = std::count_if(repaired.tracks.samples.begin(),
                                   repaired.tracks.samples.end(),
                                   [](const auto& s) { return !s.has_value(); });
  std::printf("%zu gaps, %ld samples left empty\n",
              repaired.gaps.size(),
              static_cast<long>(empty));
  measure_bones(repaired.tracks);
  measure_steps(repaired.tracks);
  return 0;
}
