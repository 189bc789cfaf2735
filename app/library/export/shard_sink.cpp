// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "app/library/export/clip_sinks.h"
#include "core/base/format_text.h"
#include "recordings/library/clip_record_file.h"

namespace marey::app {

Status ShardSink::check(const ExportedClip& /*clip*/) const {
  return Done{};
}

Status ShardSink::add(const ExportedClip& clip) {
  const ClipRecord& record = clip.record;
  const std::string split = record.split.empty() ? "all" : record.split;
  const auto motion = clip_npz(clip);
  if (!motion) return motion.error();
  const std::string facts = recordings::clip_record_text(record);
  const std::uint64_t bytes = recordings::TarWriter::size_of_entry(motion->size()) +
                              recordings::TarWriter::size_of_entry(facts.size());
  auto open = open_.find(split);
  // A clip that is larger than a shard gets one of its own.
  if (open != open_.end() && open->second.tar.size() + bytes > max_bytes_) {
    if (const Status ok = end_shard(split); !ok) return ok;
    open = open_.end();
  }
  if (open == open_.end()) {
    const std::string file = split + format_text("-%05d.tar", count_[split]++);
    auto tar = recordings::TarWriter::create(folder_ / file);
    if (!tar) return tar.error();
    open = open_.emplace(split, Shard{*std::move(tar), file}).first;
  }
  Shard& shard = open->second;
  shard.tar.add(record.clip_id + ".npz", *motion);
  shard.tar.add(record.clip_id + ".json", facts);
  shard.frames += static_cast<std::int64_t>(clip.motion.motion.poses.size());
  ++shard.clips;
  return Done{};
}

Status ShardSink::end_shard(const std::string& split) {
  const auto at = open_.find(split);
  Shard& shard = at->second;
  const std::uint64_t bytes = shard.tar.size();
  if (const Status ok = shard.tar.commit(); !ok) return ok;
  done_[shard.file] = {{"file", shard.file},
                       {"split", split},
                       {"clips", shard.clips},
                       {"frames", shard.frames},
                       {"bytes", bytes}};
  open_.erase(at);
  return Done{};
}

Status ShardSink::finish() {
  while (!open_.empty()) {
    if (const Status ok = end_shard(open_.begin()->first); !ok) return ok;
  }
  auto shards = nlohmann::ordered_json::array();
  for (auto& [file, facts] : done_) shards.push_back(std::move(facts));
  const nlohmann::ordered_json index{{"format", 1}, {"shards", std::move(shards)}};
  return recordings::write_file(folder_ / "index.json", index.dump(2) + "\n");
}

}  // namespace marey::app
