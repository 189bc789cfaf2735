// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <limits>
#include <utility>

#include "app/library/export/clip_sinks.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

/// Returns the names of library::matching_features()'s columns.
std::vector<std::string> feature_names() {
  std::vector<std::string> out;
  for (const char* part : {"left_foot", "right_foot"}) {
    for (const char* axis : {"across", "up", "forward"}) {
      out.push_back(std::string(part) + "_" + axis + "_m");
    }
  }
  for (const char* part : {"left_foot", "right_foot", "hips"}) {
    for (const char* axis : {"across", "up", "forward"}) {
      out.push_back(std::string(part) + "_" + axis + "_m_s");
    }
  }
  for (const char* part : {"path", "facing"}) {
    const std::string unit = part == std::string("path") ? "_m" : "";
    for (const char* time : {"0.33", "0.67", "1.00"}) {
      for (const char* axis : {"across", "forward"}) {
        out.push_back(std::string(part) + "_" + time + "_s_" + axis + unit);
      }
    }
  }
  return out;
}

}  // namespace

Status MatchingSink::check(const ExportedClip& clip) const {
  const auto map = retarget::map_body(clip.motion.motion.skeleton);
  return map ? Status(Done{}) : Status(map.error());
}

Status MatchingSink::add(const ExportedClip& clip) {
  const Motion& motion = clip.motion.motion;
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  const std::vector<float> features = library::matching_features(motion, *map);
  constexpr auto kColumns = static_cast<std::size_t>(library::kMatchingCount);
  const std::size_t start = database_.features.size() / kColumns;
  const std::size_t stop = start + features.size() / kColumns;
  if (stop > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    return bad_input("clip " + clip.record.clip_id,
                     "the database has more than 2147483647 frames",
                     "export fewer clips");
  }
  database_.features.insert(database_.features.end(), features.begin(), features.end());
  database_.starts.push_back(static_cast<std::int32_t>(start));
  database_.stops.push_back(static_cast<std::int32_t>(stop));
  database_.rates_hz.push_back(motion.rate.hz);
  database_.clip_ids.push_back(clip.record.clip_id);
  statistics_.add(features);
  return Done{};
}

Status MatchingSink::finish() {
  const library::MatchingScale scale = statistics_.scale();
  database_.offset.assign(scale.offset.begin(), scale.offset.end());
  database_.scale.assign(scale.scale.begin(), scale.scale.end());
  database_.columns = feature_names();
  for (std::size_t i = 0; i < database_.features.size(); ++i) {
    const std::size_t column = i % scale.offset.size();
    database_.features[i] =
        (database_.features[i] - scale.offset[column]) / scale.scale[column];
  }
  const auto bytes = recordings::matching_bytes(database_);
  if (!bytes) return bytes.error();
  return recordings::write_file(folder_ / "database.npz", *bytes);
}

}  // namespace marey::app
