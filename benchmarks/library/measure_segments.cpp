// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_segments FOLDER
//
// The division of motions at changes of content (library/segments/novelty.h). FOLDER has
// the folders bandai/ and cmu/ of ../shared/data/library, unpacked. Clips of Bandai are
// put one after the other, five at a time, of 2 s or more each, neighbours of different
// content: precision and recall of the joints within 0.5 s. Then the number of changes in
// the motions of CMU. docs/accuracy/library_duplicates.md has figures.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "library/features/body_features.h"
#include "library/segments/novelty.h"

#include "benchmarks/library/library_clips.h"

namespace marey {
namespace {

constexpr int kJoined = 5;
constexpr int kMinRows = 20;
constexpr int kErrorRows = 5;

struct JoinedClips {
  std::vector<float> rows;
  std::vector<int> joints;
};

// The next clips of the half that differ in content from the one before.
std::vector<JoinedClips> join(const std::vector<BenchmarkClip>& clips, bool tuned) {
  std::vector<const BenchmarkClip*> left;
  for (const BenchmarkClip& clip : clips) {
    if (clip.count() >= kMinRows && is_tuned_on(clip.name) == tuned)
      left.push_back(&clip);
  }
  // A step that visits contents in turn, the same in every run.
  const std::size_t step = left.size() / 7 + 1;
  std::vector<JoinedClips> out;
  JoinedClips joined;
  std::string content;
  int parts = 0;
  for (std::size_t first = 0; first < step; ++first) {
    for (std::size_t k = first; k < left.size(); k += step) {
      const std::string next = word_of(left[k]->name, 1);
      if (next == content) continue;
      content = next;
      if (parts > 0) {
        joined.joints.push_back(static_cast<int>(joined.rows.size()) /
                                library::kFeatureStride);
      }
      joined.rows.insert(joined.rows.end(), left[k]->rows.begin(), left[k]->rows.end());
      if (++parts < kJoined) continue;
      out.push_back(std::move(joined));
      joined = {};
      parts = 0;
      content.clear();
    }
  }
  return out;
}

void measure_joints(const std::vector<BenchmarkClip>& clips, bool tuned) {
  int joints = 0;
  int found_joints = 0;
  int changes = 0;
  int right = 0;
  const auto is_near = [](const std::vector<int>& list, int row) {
    return std::any_of(
        list.begin(), list.end(), [&](int k) { return std::abs(k - row) <= kErrorRows; });
  };
  const auto all = join(clips, tuned);
  for (const JoinedClips& joined : all) {
    const std::vector<int> found = library::find_changes(joined.rows);
    for (const int joint : joined.joints) {
      ++joints;
      found_joints += is_near(found, joint) ? 1 : 0;
    }
    for (const int change : found) {
      ++changes;
      right += is_near(joined.joints, change) ? 1 : 0;
    }
  }
  std::printf(
      "%s half: %zu motions of %d clips, %d joints: recall %.3f, precision %.3f\n",
      tuned ? "tuning" : "other",
      all.size(),
      kJoined,
      joints,
      static_cast<double>(found_joints) / std::max(1, joints),
      static_cast<double>(right) / std::max(1, changes));
}

int run(const std::filesystem::path& folder) {
  const auto bandai = read_clips(files_below(folder / "bandai", ".bvh"), {});
  for (const bool tuned : {true, false}) measure_joints(bandai, tuned);
  for (const BenchmarkClip& clip : read_clips(files_below(folder / "cmu", ".amc"), {})) {
    std::printf("%s, %.1f s, changes at", clip.name.c_str(), 0.1 * clip.count());
    for (const int row : library::find_changes(clip.rows))
      std::printf(" %.1f", 0.1 * row);
    std::printf(" s\n");
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "use: measure_segments FOLDER\n");
    return 2;
  }
  return marey::run(argv[1]);
}
