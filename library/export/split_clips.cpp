// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/split_clips.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>

#include "core/base/assert.h"

namespace marey::library {
namespace {

std::uint64_t hash_of(std::string_view kind, std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325U;
  for (const std::string_view part : {kind, text}) {
    for (const char c : part) {
      h ^= static_cast<unsigned char>(c);
      h *= 0x100000001b3U;
    }
  }
  // The high bits of FNV-1a depend little on the last letters.
  h ^= h >> 33U;
  h *= 0xff51afd7ed558ccdU;
  h ^= h >> 33U;
  h *= 0xc4ceb9fe1a85ec53U;
  return h ^ (h >> 33U);
}

/// Disjoint sets of clips (Tarjan 1975, with path halving).
class ClipGroups {
 public:
  explicit ClipGroups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

ClipGroups group_clips(std::span<const ClipRecord> records, SplitBy by) {
  std::map<std::string_view, std::size_t> clips;
  std::map<std::string_view, std::size_t> subjects;
  std::map<std::string_view, std::size_t> sources;
  for (std::size_t i = 0; i < records.size(); ++i) clips.emplace(records[i].clip_id, i);
  ClipGroups groups(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const ClipRecord& clip = records[i];
    for (const std::string& other : {clip.duplicate_of, clip.mirror_of}) {
      const auto found = clips.find(other);
      if (!other.empty() && found != clips.end()) groups.join(i, found->second);
    }
    if (by == SplitBy::kClip) continue;
    const auto& [source, subject] = std::pair(std::string_view(clip.provenance.source_id),
                                              std::string_view(clip.provenance.subject));
    if (!subject.empty()) groups.join(i, subjects.emplace(subject, i).first->second);
    if (!source.empty()) groups.join(i, sources.emplace(source, i).first->second);
  }
  return groups;
}

/// The smallest hash of a group, of its most lasting property.
struct GroupKey {
  int rank = 3;  ///< 0 subject, 1 source or original, 2 any clip.
  std::uint64_t hash = 0;

  void add(int new_rank, std::uint64_t new_hash) {
    if (new_rank > rank || (new_rank == rank && new_hash >= hash)) return;
    rank = new_rank;
    hash = new_hash;
  }
};

void add_clip(GroupKey& key, const ClipRecord& clip, SplitBy by) {
  if (by == SplitBy::kSubject) {
    const Provenance& origin = clip.provenance;
    if (!origin.subject.empty()) key.add(0, hash_of("subject ", origin.subject));
    if (!origin.source_id.empty()) key.add(1, hash_of("source ", origin.source_id));
  } else if (clip.duplicate_of.empty() && clip.mirror_of.empty()) {
    key.add(1, hash_of("clip ", clip.clip_id));
  }
  key.add(2, hash_of("clip ", clip.clip_id));
}

}  // namespace

std::vector<std::string> split_clips(
    std::span<const ClipRecord> records,
    std::span<const std::pair<std::string, double>> splits,
    SplitBy by) {
  MAREY_ASSERT(!splits.empty());
  ClipGroups groups = group_clips(records, by);
  std::vector<GroupKey> keys(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    add_clip(keys[groups.find(i)], records[i], by);
  }
  std::vector<std::string> out;
  out.reserve(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double place = static_cast<double>(keys[groups.find(i)].hash >> 11U) * 0x1p-53;
    double end = 0.0;
    std::size_t split = 0;
    // A last split without a share must stay empty, whatever rounding does.
    std::size_t last = splits.size() - 1;
    while (last > 0 && splits[last].second <= 0.0) --last;
    for (; split < last; ++split) {
      end += splits[split].second;
      if (place < end) break;
    }
    out.push_back(splits[split].first);
  }
  return out;
}

}  // namespace marey::library
