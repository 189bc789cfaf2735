// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_library_index [CLIPS [HOURS]]
//
// Time and memory of the files that searches in a library read. Simulated records (100
// 000 clips unless stated, with ten labels and 20 figures each) are written to
// library.sqlite, queried and listed. Every query opens the index again, as a new process
// does. Simulated rows (10 hours unless stated) are written, and searched after the
// system has dropped them from its cache. docs/accuracy/library.md has figures.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"
#include "library/search/find_similar.h"
#include <fcntl.h>
#include <unistd.h>

#include "app/library/find/open_search.h"
#include "app/library/find/query_clips.h"
#include "core/base/stopwatch.h"
#include "recordings/library/library_index.h"
#include "recordings/library/library_records.h"
#include "recordings/library/rows_file.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/files/simulated_records.h"
#include "tests/support/program/scratch_folder.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

// Returns the largest memory of this process so far. [MB]
double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024.0;
  }
  return 0.0;
}

// Time on the clock, and of the processor, since construction. [s]
class BothTimes {
 public:
  [[nodiscard]] double wall_s() const { return wall_.seconds(); }
  [[nodiscard]] double processor_s() const {
    return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
  }

 private:
  Stopwatch wall_;
  std::clock_t start_ = std::clock();
};

template <class T>
const T& needed(const Result<T>& result) {
  if (result) return *result;
  std::fprintf(stderr, "%s\n", result.error().message().c_str());
  std::exit(1);
}

void print_row(const std::string& what, const std::string& value, const char* bar) {
  std::printf("| %s | %s | %s |\n", what.c_str(), value.c_str(), bar);
  std::fflush(stdout);
}

std::string number_text(double value, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f %s", value, unit);
  return text;
}

std::string times_text(double wall_ms, double processor_ms) {
  return number_text(wall_ms, "ms") + " (" + number_text(processor_ms, "ms") + ")";
}

// Prints the median time of nine calls, and that of the processor.
void measure(const std::string& what,
             const char* bar,
             const std::function<void()>& call) {
  std::vector<double> wall;
  std::vector<double> processor;
  for (int k = 0; k < 9; ++k) {
    const BothTimes times;
    call();
    wall.push_back(1000.0 * times.wall_s());
    processor.push_back(1000.0 * times.processor_s());
  }
  std::sort(wall.begin(), wall.end());
  std::sort(processor.begin(), processor.end());
  print_row(what, times_text(wall[4], processor[4]), bar);
}

void measure_queries(const fs::path& place) {
  for (const char* expression :
       {"content=walk and speed>1.2",
        "content=walk and quality=pass and speed>1.2 and has(hand_right above head for "
        "0.3 s)",
        "content=walk",
        "label~walk",
        "speed>1.2",
        "text(\"turn left\")",
        "quality=pass",
        "licence!=unknown",
        "name~walk",
        "source~take_0001",
        "seconds>3",
        "frames>100",
        "problem=spike",
        "event(left.strike)",
        "not (content=walk or content=run) and split=train"}) {
    const auto count = needed(app::query_clips(place, expression)).size();
    measure(std::string("`") + expression + "`, " + std::to_string(count) + " clips",
            "100 ms",
            [&] { (void)needed(app::query_clips(place, expression)); });
  }
}

void measure_index(const fs::path& place, int clips) {
  const fs::path index = place / "library.sqlite";
  testing::SimulatedRecordsOptions options;
  options.clips = clips;
  std::printf("| %d clips | time (of the processor) | bar |\n|---|---|---|\n", clips);
  {
    const auto records = testing::simulated_records(options);
    print_row("records in memory", number_text(peak_memory_mb(), "MB"), "");
    const BothTimes times;
    (void)needed(recordings::write_library_index(index, records));
    print_row("index written",
              number_text(times.wall_s(), "s") + " (" +
                  number_text(times.processor_s(), "s") + ")",
              "20 s");
    print_row("memory with the records", number_text(peak_memory_mb(), "MB"), "1000 MB");
  }
  print_row("library.sqlite",
            number_text(static_cast<double>(fs::file_size(index)) / 1e6, "MB"),
            "");
  measure_queries(place);
  measure("list of 3000 clips", "1000 ms", [&] {
    (void)needed(recordings::read_clip_summaries(index, clips / 2, 3000));
  });
  const BothTimes times;
  (void)needed(recordings::read_library_records(index));
  print_row("all records read",
            times_text(1000.0 * times.wall_s(), 1000.0 * times.processor_s()),
            "");
}

// Returns rows that change smoothly, as features do.
std::vector<float> simulated_rows(std::uint64_t seed, int count) {
  testing::Dice dice(seed);
  std::vector<float> out(static_cast<std::size_t>(count) * library::kFeatureStride);
  for (std::size_t column = 0; column < library::kFeatureCount; ++column) {
    const double phase = dice.between(0.0, 6.28);
    const double rate = dice.between(0.2, 1.0);
    const double size = dice.between(0.05, 0.4);
    for (int row = 0; row < count; ++row) {
      out[static_cast<std::size_t>(row) * library::kFeatureStride + column] =
          static_cast<float>(size * std::sin(phase + rate * row));
    }
  }
  return out;
}

// Removes a file from the system's cache.
void drop_from_cache(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
  close(descriptor);
}

// Writes clips of 4.5 s. Returns the number of clips.
int write_rows(const fs::path& folder, double hours) {
  constexpr int kRows = 45;
  auto features = recordings::RowsFileWriter::create(folder / "features.f32",
                                                     library::kFeatureStride);
  auto windows =
      recordings::RowsFileWriter::create(folder / "windows.f32", library::kWindowFloats);
  auto wholes =
      recordings::RowsFileWriter::create(folder / "wholes.f32", library::kWholeFloats);
  (void)needed(features);
  (void)needed(windows);
  (void)needed(wholes);
  const int clips = std::max(1, static_cast<int>(hours * 36000.0 / kRows));
  for (int clip = 0; clip < clips; ++clip) {
    const auto rows = simulated_rows(static_cast<std::uint64_t>(clip) + 1, kRows);
    (*features).add_clip(rows);
    (*windows).add_clip(library::feature_windows(rows));
    (*wholes).add_clip(library::whole_clip_row(rows));
  }
  (void)needed((*features).commit());
  (void)needed((*windows).commit());
  (void)needed((*wholes).commit());
  return clips;
}

void measure_rows(const fs::path& place, double hours) {
  const fs::path folder = place / "search" / "rows";
  const BothTimes writing;
  const int clips = write_rows(folder, hours);
  std::printf("\n| %.1f h, %d clips | time (of the processor) | bar |\n|---|---|---|\n",
              hours,
              clips);
  print_row("rows computed and written",
            times_text(1000.0 * writing.wall_s(), 1000.0 * writing.processor_s()),
            "");
  testing::SimulatedRecordsOptions options;
  options.clips = clips;
  recordings::IndexHead head;
  head.search = "rows";
  (void)needed(recordings::write_library_index(
      place / "library.sqlite", testing::simulated_records(options), head));
  const auto query = simulated_rows(1'000'000, 21);
  for (const char* name : {"features.f32", "windows.f32", "wholes.f32"}) {
    drop_from_cache(folder / name);
  }
  const auto search = [&] {
    const auto opened = app::open_search(place);
    (void)library::find_similar(query, needed(opened).rows());
  };
  const BothTimes first;
  search();
  print_row("first query after the library is opened, rows not in the cache",
            times_text(1000.0 * first.wall_s(), 1000.0 * first.processor_s()),
            "500 ms");
  measure("the same query again, with opening", "", search);
}

int run(int clips, double hours) {
  const testing::ScratchFolder folder;
  measure_index(folder.path(), clips);
  measure_rows(folder.path(), hours);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  const int clips = argc > 1 ? std::atoi(argv[1]) : 100'000;
  const double hours = argc > 2 ? std::atof(argv[2]) : 10.0;
  if (argc > 3 || clips < 1 || !(hours > 0.0 && hours <= 1000.0)) {
    std::fprintf(stderr, "usage: measure_library_index [CLIPS [HOURS]]\n");
    return 2;
  }
  return marey::run(clips, hours);
}
