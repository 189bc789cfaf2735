// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_statistics.h"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace marey::app {
namespace {

using nlohmann::ordered_json;

double rounded(double value) {
  constexpr double kPerUnit = 1000.0;
  return std::round(value * kPerUnit) / kPerUnit;
}

ordered_json of(const LatencyHistogram& times) {
  constexpr double kMs = 1000.0;
  return {{"count", times.count()},
          {"p50_ms", rounded(kMs * times.quantile_s(0.5))},
          {"p95_ms", rounded(kMs * times.quantile_s(0.95))},
          {"p99_ms", rounded(kMs * times.quantile_s(0.99))},
          {"most_ms", rounded(kMs * times.max_s())}};
}

ordered_json of(const LiveStatistics& figures, std::size_t c) {
  const LiveCameraFigures& camera = figures.cameras[c];
  return {{"name", camera.name},
          {"pictures", camera.pictures},
          {"dropped", camera.dropped},
          {"stale", camera.stale},
          {"broken", camera.broken},
          {"unused", camera.unused},
          {"missing", camera.missing},
          {"decode", of(figures.times.decode[c])},
          {"detect", of(figures.times.detect[c])}};
}

}  // namespace

std::string live_json_text(const LiveStatistics& figures) {
  const LiveTimes& times = figures.times;
  ordered_json out{{"frames", figures.frames},
                   {"tracked", figures.tracked},
                   {"lost", figures.lost},
                   {"found_anew", figures.relocalizations},
                   {"seconds", rounded(figures.seconds)},
                   {"behind_s", rounded(figures.behind_s)},
                   {"frame_to_packet", of(times.frame_to_packet)},
                   {"stages",
                    {{"wait", of(times.wait)},
                     {"solve", of(times.solve)},
                     {"retarget", of(times.retarget)},
                     {"encode", of(times.encode)},
                     {"send", of(times.send)}}},
                   {"cameras", ordered_json::array()},
                   {"outputs", ordered_json::array()},
                   {"minutes", ordered_json::array()}};
  for (std::size_t c = 0; c < figures.cameras.size(); ++c) {
    out["cameras"].push_back(of(figures, c));
  }
  for (const OutputCounts& output : figures.outputs) {
    out["outputs"].push_back({{"name", output.name},
                              {"sent", output.counts.sent},
                              {"refused", output.counts.refused},
                              {"failed", output.counts.failed}});
  }
  for (const LiveMinute& minute : figures.minutes) {
    out["minutes"].push_back({{"frames", minute.frames},
                              {"p50_ms", rounded(1000.0 * minute.p50_s)},
                              {"p95_ms", rounded(1000.0 * minute.p95_s)},
                              {"resident_mb", rounded(minute.resident_mb)}});
  }
  out["takes"] = figures.takes;
  if (figures.recording_trouble) {
    out["recording_trouble"] = figures.recording_trouble->message();
  }
  // Names are the user's: what is not UTF-8 in them must not end the program.
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double all_pages = 0.0;
  double resident_pages = 0.0;
  if (!(statm >> all_pages >> resident_pages)) return 0.0;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace marey::app
