// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the search by content (library/search/find_similar.h).
//
//   measure_search FOLDER [--cache FOLDER] [--hours 10] [--candidates N]
//
// FOLDER has the folders bandai/ and cmu/ of ../shared/data/library, unpacked. Features
// are kept in the cache folder, if one is given. Prints: precision of content, mirrored
// hands, one take in two files, recall against the exact search and time per query. No
// query is a clip of the library that it searches.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"
#include "library/search/find_similar.h"

#include "benchmarks/library/library_clips.h"
#include "core/base/quantile.h"
#include "tests/support/program/thread_time.h"

namespace marey {
namespace {

using library::FindSimilarOptions;
using library::SimilarMotion;

constexpr int kFolds = 5;
constexpr int kTop = 10;

struct Settings {
  std::filesystem::path folder;
  std::filesystem::path cache;
  double hours = 10.0;
  FindSimilarOptions options;
};

struct Clips {
  std::vector<BenchmarkClip> bandai;
  std::vector<BenchmarkClip> cmu_bvh;    // 60 Hz, 101 joints.
  std::vector<BenchmarkClip> cmu_rates;  // Dances of another skeleton.
  std::vector<BenchmarkClip> cmu_amc;    // 120 Hz: queries.
};

Clips read_all(const Settings& settings) {
  const auto read = [&](const char* folder, const char* ending, const char* name) {
    const auto cache = settings.cache.empty() ? settings.cache : settings.cache / name;
    return read_clips(files_below(settings.folder / folder, ending), cache);
  };
  return {read("bandai", ".bvh", "bandai"),
          read("cmu/bvh_iclone_60hz", ".bvh", "iclone"),
          read("cmu/bvh_rates", ".bvh", "rates"),
          read("cmu/amc", ".amc", "amc")};
}

std::string content_of(const BenchmarkClip& clip) {
  return word_of(clip.name, 1);
}

using IsRight = bool (*)(const std::string& asked, const std::string& found);

bool is_same_content(const std::string& asked, const std::string& found) {
  return asked == found;
}

// "wave-left-hand" asks, mirrored, for any movement of the right hand, and vice versa.
bool is_other_hand(const std::string& asked, const std::string& found) {
  const bool asks_left = asked.find("left-hand") != std::string::npos;
  return found.find(asks_left ? "right-hand" : "left-hand") != std::string::npos;
}

// The middle 2 s of a clip; all of a shorter one.
std::span<const float> middle_window(const BenchmarkClip& clip) {
  const int rows = std::min(clip.count(), library::kWindowRows);
  const int first = (clip.count() - rows) / 2;
  return std::span(clip.rows).subspan(
      static_cast<std::size_t>(first) * library::kFeatureStride,
      static_cast<std::size_t>(rows) * library::kFeatureStride);
}

struct Precision {
  double right = 0.0;
  double asked = 0.0;
  int queries = 0;

  void add(int r, int a) {
    right += r;
    asked += a;
    ++queries;
  }
  [[nodiscard]] double share() const { return asked > 0.0 ? right / asked : 0.0; }
};

// Clips that a query searches.
enum class Searched {
  kOtherFolds,  // The clips of the other four fifths.
  kAllOthers,   // All clips but the query's own.
};

// Two results: queries of the half for tuning, and of the other half.
void measure_content(const std::vector<BenchmarkClip>& clips,
                     FindSimilarOptions options,
                     Searched others,
                     const std::function<bool(const BenchmarkClip&)>& is_query,
                     IsRight is_right,
                     const char* title) {
  Precision precision[2];
  Precision rare;
  const bool searches_all = others == Searched::kAllOthers;
  for (int fold = 0; fold < (searches_all ? 1 : kFolds); ++fold) {
    ClipLibrary searched;
    std::vector<std::string> contents;
    for (std::size_t k = 0; k < clips.size(); ++k) {
      if (!searches_all && static_cast<int>(k) % kFolds == fold) continue;
      searched.add(clips[k].rows);
      contents.push_back(content_of(clips[k]));
    }
    for (std::size_t k = 0; k < clips.size(); ++k) {
      if (!searches_all && static_cast<int>(k) % kFolds != fold) continue;
      if (!is_query(clips[k])) continue;
      if (searches_all) options.skipped_clip = static_cast<int>(k);
      const std::string content = content_of(clips[k]);
      const auto query = options.whole_clips ? std::span<const float>(clips[k].rows)
                                             : middle_window(clips[k]);
      const auto found = find_similar(query, searched.rows(), options);
      const int itself = searches_all && is_right(content, content) ? 1 : 0;
      const auto there = static_cast<int>(std::count_if(contents.begin(),
                                                        contents.end(),
                                                        [&](const std::string& other) {
                                                          return is_right(content, other);
                                                        })) -
                         itself;
      const auto right = std::count_if(found.begin(), found.end(), [&](const auto& f) {
        return is_right(content, contents[static_cast<std::size_t>(f.clip)]);
      });
      if (there < kTop) {
        rare.add(static_cast<int>(right), there);
      } else {
        precision[is_tuned_on(clips[k].name) ? 0 : 1].add(static_cast<int>(right), kTop);
      }
    }
  }
  std::printf("%-44s %.3f of %4d queries; other half %.3f of %4d\n",
              title,
              precision[0].share(),
              precision[0].queries,
              precision[1].share(),
              precision[1].queries);
  if (rare.queries > 0) {
    std::printf("%-44s %.3f of %4d queries\n",
                "  contents of fewer than 10 clips, of those",
                rare.share(),
                rare.queries);
  }
}

void measure_meaning(const Clips& clips, const Settings& settings) {
  const auto every = [](const BenchmarkClip&) { return true; };
  const auto one_hand = [](const BenchmarkClip& clip) {
    return content_of(clip).find("left-hand") != std::string::npos ||
           content_of(clip).find("right-hand") != std::string::npos;
  };
  for (const Searched others : {Searched::kOtherFolds, Searched::kAllOthers}) {
    FindSimilarOptions options = settings.options;
    std::printf("precision@10 of content, %s\n",
                others == Searched::kAllOthers ? "among all other clips"
                                               : "among the other four fifths");
    const auto measure = [&](bool is_whole, bool is_mirrored, const char* title) {
      options.whole_clips = is_whole;
      options.mirror = is_mirrored;
      if (is_mirrored) {
        measure_content(clips.bandai, options, others, one_hand, is_other_hand, title);
      } else {
        measure_content(clips.bandai, options, others, every, is_same_content, title);
      }
    };
    measure(false, false, "  2 s windows");
    measure(false, true, "  2 s windows, mirrored: the other hand");
    measure(true, false, "  whole clips");
    measure(true, true, "  whole clips, mirrored: the other hand");
  }
}

// CMU 02_NN as AMC finds its own BVH among all clips.
void measure_own_take(const Clips& clips, const Settings& settings) {
  ClipLibrary searched;
  std::vector<std::string> names;
  for (const auto* group : {&clips.bandai, &clips.cmu_bvh, &clips.cmu_rates}) {
    for (const BenchmarkClip& clip : *group) {
      searched.add(clip.rows);
      names.push_back(clip.name);
    }
  }
  for (const bool is_whole : {false, true}) {
    FindSimilarOptions options = settings.options;
    options.whole_clips = is_whole;
    int first = 0;
    for (const BenchmarkClip& clip : clips.cmu_amc) {
      const auto query =
          is_whole ? std::span<const float>(clip.rows) : middle_window(clip);
      const auto found = find_similar(query, searched.rows(), options);
      const std::string own = "0" + clip.name;
      const bool is_first =
          !found.empty() && names[static_cast<std::size_t>(found[0].clip)] == own;
      first += is_first ? 1 : 0;
      if (found.size() < 2) continue;
      std::printf("  %s: first %s %.3f, second %s %.3f%s\n",
                  clip.name.c_str(),
                  names[static_cast<std::size_t>(found[0].clip)].c_str(),
                  found[0].distance,
                  names[static_cast<std::size_t>(found[1].clip)].c_str(),
                  found[1].distance,
                  is_first ? "" : "  WRONG");
    }
    std::printf("CMU 02 as AMC finds its own BVH first, %s: %d of %zu\n",
                is_whole ? "whole clips" : "2 s windows",
                first,
                clips.cmu_amc.size());
  }
}

// Features at another speed: positions between rows, and rates times the speed.
std::vector<float> warped(const std::vector<float>& rows, double speed) {
  constexpr auto kStride = static_cast<std::size_t>(library::kFeatureStride);
  const auto count = static_cast<double>(rows.size() / kStride);
  std::vector<float> out;
  for (double at = 0.0; at <= count - 1.0; at += speed) {
    const auto before = static_cast<std::size_t>(at);
    const std::size_t after = std::min(before + 1, rows.size() / kStride - 1);
    const auto part = static_cast<float>(at - static_cast<double>(before));
    for (std::size_t c = 0; c < kStride; ++c) {
      const float value =
          (1.0F - part) * rows[before * kStride + c] + part * rows[after * kStride + c];
      out.push_back(c < 39 ? value : static_cast<float>(speed) * value);
    }
  }
  return out;
}

void print_times(const char* title,
                 std::vector<double> wall_ms,
                 std::vector<double> cpu_ms) {
  std::printf("  %-22s wall p50 %.1f p95 %.1f ms; processor p50 %.1f p95 %.1f ms\n",
              title,
              quantile(wall_ms, 0.5),
              quantile(wall_ms, 0.95),
              quantile(cpu_ms, 0.5),
              quantile(cpu_ms, 0.95));
}

struct TimedSearch {
  std::vector<double> wall_ms, cpu_ms;

  std::vector<SimilarMotion> operator()(std::span<const float> query,
                                        const library::SearchRows& rows,
                                        const FindSimilarOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const double cpu = testing::thread_time_s();
    auto found = find_similar(query, rows, options);
    cpu_ms.push_back(1e3 * (testing::thread_time_s() - cpu));
    wall_ms.push_back(std::chrono::duration<double, std::milli>(
                          std::chrono::steady_clock::now() - start)
                          .count());
    return found;
  }
};

// Every 10th clip from clip `first` on is a query, if it has 2 s. The others and their
// copies are the library.
void measure_recall(const Clips& clips, const Settings& settings, std::size_t first) {
  std::vector<const BenchmarkClip*> queries, kept;
  for (std::size_t k = 0; k < clips.bandai.size(); ++k) {
    (k % 10 == first ? queries : kept).push_back(&clips.bandai[k]);
  }
  ClipLibrary searched;
  for (const double speed : {1.0, 0.8, 1.25, 0.9, 1.1, 0.7}) {
    for (const bool is_mirrored : {false, true}) {
      for (const BenchmarkClip* clip : kept) {
        if (searched.hours() >= settings.hours) break;
        const std::vector<float> copy = warped(clip->rows, speed);
        searched.add(is_mirrored ? library::mirrored_features(copy) : copy);
      }
    }
  }
  std::erase_if(queries, [](const BenchmarkClip* clip) {
    return clip->count() < library::kWindowRows;
  });
  std::printf("recall and time: %d clips, %.2f h, %zu windows, %zu queries of 2 s\n",
              searched.count(),
              searched.hours(),
              searched.rows().windows.values.size() / library::kWindowFloats,
              queries.size());
  std::vector<std::vector<SimilarMotion>> truths;
  TimedSearch exact;
  FindSimilarOptions options = settings.options;
  options.exact = true;
  for (const BenchmarkClip* clip : queries) {
    truths.push_back(exact(middle_window(*clip), searched.rows(), options));
  }
  print_times("exact", exact.wall_ms, exact.cpu_ms);
  options.exact = false;
  for (const int candidates : {100, 200, 400, 800, 1600}) {
    options.candidates = candidates;
    TimedSearch fast;
    double recalled = 0.0;
    double asked = 0.0;
    for (std::size_t q = 0; q < queries.size(); ++q) {
      const auto found = fast(middle_window(*queries[q]), searched.rows(), options);
      asked += static_cast<double>(truths[q].size());
      for (const SimilarMotion& truth : truths[q]) {
        recalled += std::any_of(found.begin(), found.end(), [&](const SimilarMotion& f) {
          return f.clip == truth.clip;
        });
      }
    }
    std::printf("  %4d candidates: recall@10 %.3f\n", candidates, recalled / asked);
    print_times("", fast.wall_ms, fast.cpu_ms);
  }
}

int run(int argc, char** argv) {
  Settings settings;
  for (int k = 1; k < argc; ++k) {
    const bool has_value = k + 1 < argc;
    if (std::strcmp(argv[k], "--cache") == 0 && has_value) {
      settings.cache = argv[++k];
    } else if (std::strcmp(argv[k], "--hours") == 0 && has_value) {
      settings.hours = std::stod(argv[++k]);
    } else if (std::strcmp(argv[k], "--candidates") == 0 && has_value) {
      settings.options.candidates = std::stoi(argv[++k]);
    } else {
      settings.folder = argv[k];
    }
  }
  if (settings.folder.empty()) {
    std::fprintf(stderr, "usage: measure_search FOLDER [--cache FOLDER] [--hours H]\n");
    return 2;
  }
  const Clips clips = read_all(settings);
  // The number of candidates was chosen with the first queries.
  measure_recall(clips, settings, 3);
  measure_recall(clips, settings, 7);
  measure_own_take(clips, settings);
  measure_meaning(clips, settings);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run(argc, argv);
}
