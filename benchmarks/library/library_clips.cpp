// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/library/library_clips.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "library/clips/put_on_floor.h"
#include "library/features/body_features.h"
#include "library/features/feature_basis.h"

#include "app/motion/retarget_files.h"
#include "core/base/parallel.h"
#include "retarget/body/body_map.h"

namespace marey {
namespace {

BenchmarkClip read_clip(const std::filesystem::path& file) {
  BenchmarkClip clip{file.stem().string(), {}};
  Result<app::ReadMotion> read = app::read_motion(file);
  if (!read.has_value()) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), read.error().message().c_str());
    std::exit(1);
  }
  const auto map = retarget::map_body((*read).motion.skeleton);
  if (!map.has_value()) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), map.error().message().c_str());
    std::exit(1);
  }
  library::put_on_floor((*read).motion, *map);
  clip.rows = library::body_features((*read).motion, *map).rows;
  return clip;
}

std::vector<BenchmarkClip> read_cache(const std::filesystem::path& cache) {
  std::vector<BenchmarkClip> clips;
  std::ifstream in(cache, std::ios::binary);
  std::string name;
  std::string size;
  while (std::getline(in, name) && std::getline(in, size)) {
    BenchmarkClip clip{name, std::vector<float>(std::stoul(size))};
    in.read(reinterpret_cast<char*>(clip.rows.data()),
            static_cast<std::streamsize>(4 * clip.rows.size()));
    clips.push_back(std::move(clip));
  }
  return clips;
}

void write_cache(const std::filesystem::path& cache,
                 const std::vector<BenchmarkClip>& clips) {
  std::ofstream out(cache, std::ios::binary);
  for (const BenchmarkClip& clip : clips) {
    out << clip.name << '\n' << clip.rows.size() << '\n';
    out.write(reinterpret_cast<const char*>(clip.rows.data()),
              static_cast<std::streamsize>(4 * clip.rows.size()));
  }
}

template <class T>
void append(std::vector<T>& to, std::span<const T> from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

int BenchmarkClip::count() const {
  return static_cast<int>(rows.size()) / library::kFeatureStride;
}

std::string word_of(const std::string& name, int k) {
  std::size_t first = 0;
  for (; k > 0; --k) {
    const std::size_t next = name.find('_', first);
    if (next == std::string::npos) return "";
    first = next + 1;
  }
  return name.substr(first, name.find('_', first) - first);
}

std::vector<BenchmarkClip> read_clips(const std::vector<std::filesystem::path>& files,
                                      const std::filesystem::path& cache) {
  if (!cache.empty() && std::filesystem::exists(cache)) return read_cache(cache);
  std::vector<BenchmarkClip> clips(files.size());
  in_parallel(files.size(), 2, [&](std::size_t k) { clips[k] = read_clip(files[k]); });
  std::sort(clips.begin(), clips.end(), [](const auto& a, const auto& b) {
    return a.name < b.name;
  });
  if (!cache.empty()) write_cache(cache, clips);
  return clips;
}

std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder,
                                               const std::string& ending) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ending) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_tuned_on(const std::string& name) {
  if (name.starts_with("dataset-1")) return true;
  // FNV-1a, 64 bits; a middle bit.
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  return (hash >> 32 & 1) == 0;
}

void ClipLibrary::add(std::span<const float> rows) {
  append<float>(features_, rows);
  append<float>(windows_, library::feature_windows(rows));
  append<float>(wholes_, library::whole_clip_row(rows));
  feature_begins_.push_back(features_.size() / library::kFeatureStride);
  window_begins_.push_back(windows_.size() / library::kWindowFloats);
  whole_begins_.push_back(wholes_.size() / library::kWholeFloats);
}

library::SearchRows ClipLibrary::rows() const {
  return {{features_, library::kFeatureStride, feature_begins_},
          {windows_, library::kWindowFloats, window_begins_},
          {wholes_, library::kWholeFloats, whole_begins_}};
}

double ClipLibrary::hours() const {
  return static_cast<double>(feature_begins_.back()) / library::kFeatureRate_hz / 3600.0;
}

}  // namespace marey
