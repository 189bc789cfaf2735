// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "library/search/matching_features.h"
#include <nlohmann/json.hpp>

#include "app/library/export/clip_sink.h"
#include "core/skeleton.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/export_arrays.h"
#include "recordings/library/tar_writer.h"

// Layouts with files of several clips, for make_clip_sink().
namespace marey::app {

/// WebDataset: SPLIT-00000.tar with CLIP.npz and CLIP.json, and index.json.
class ShardSink : public ClipSink {
 public:
  explicit ShardSink(std::filesystem::path folder, std::uint64_t max_bytes = 256000000)
      : folder_(std::move(folder)), max_bytes_(max_bytes) {}
  Status check(const ExportedClip& clip) const override;
  Status add(const ExportedClip& clip) override;
  Status finish() override;

 private:
  struct Shard {
    recordings::TarWriter tar;
    std::string file;
    int clips = 0;
    std::int64_t frames = 0;
  };
  Status end_shard(const std::string& split);

  std::filesystem::path folder_;
  std::uint64_t max_bytes_;
  std::map<std::string, Shard> open_;                   ///< By split.
  std::map<std::string, int> count_;                    ///< Shards begun, by split.
  std::map<std::string, nlohmann::ordered_json> done_;  ///< By file.
};

/// One array of all frames: motion.f32, clips.csv, skeleton.json.
class PackSink : public ClipSink {
 public:
  explicit PackSink(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Status check(const ExportedClip& clip) const override;
  Status add(const ExportedClip& clip) override;
  Status finish() override;

 private:
  /// Returns the number of a skeleton with the same lengths; a new one if there is none.
  std::size_t number_of(const Skeleton& skeleton);

  std::filesystem::path folder_;
  std::optional<recordings::AtomicFile> file_;
  std::vector<Skeleton> skeletons_;
  std::int64_t frames_ = 0;
  std::string table_;  ///< Lines of clips.csv.
};

/// A database for motion matching: database.npz. Holds the features of all clips, 108
/// bytes a frame.
class MatchingSink : public ClipSink {
 public:
  explicit MatchingSink(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Status check(const ExportedClip& clip) const override;
  Status add(const ExportedClip& clip) override;
  Status finish() override;

 private:
  std::filesystem::path folder_;
  recordings::MatchingDatabase database_;
  library::MatchingStatistics statistics_;
};

}  // namespace marey::app
