// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_library_index [CLIPS]
//
// Time and memory of library.sqlite: simulated records (100 000 clips unless stated, with
// ten labels and 20 figures each) are written, queried and listed. Every query opens the
// index again, as a new process does. docs/accuracy/library.md has figures.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "core/base/stopwatch.h"
#include "recordings/library/library_index.h"
#include "recordings/library/library_records.h"
#include "recordings/library/select_clips.h"
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

void print_row(const char* what, double value, const char* unit, const char* bar) {
  std::printf("| %s | %.1f %s | %s |\n", what, value, unit, bar);
}

// Returns the median time of five calls. [ms]
double median_ms(const std::function<void()>& call) {
  std::vector<double> times;
  for (int k = 0; k < 5; ++k) {
    const Stopwatch watch;
    call();
    times.push_back(1000.0 * watch.seconds());
  }
  std::sort(times.begin(), times.end());
  return times[2];
}

template <class T>
const T& needed(const Result<T>& result) {
  if (result) return *result;
  std::fprintf(stderr, "%s\n", result.error().message().c_str());
  std::exit(1);
}

void measure_queries(const fs::path& index);

int run(int clips) {
  const testing::ScratchFolder folder;
  const fs::path index = folder / "library.sqlite";
  testing::SimulatedRecordsOptions options;
  options.clips = clips;
  std::printf("| %d clips | value | bar |\n|---|---|---|\n", clips);
  {
    const auto records = testing::simulated_records(options);
    print_row("records, in memory", peak_memory_mb(), "MB", "");
    const Stopwatch watch;
    (void)needed(recordings::write_library_index(index, records));
    print_row("index written", watch.seconds(), "s", "20 s");
    print_row("memory, with the records", peak_memory_mb(), "MB", "1000 MB");
  }
  print_row("library.sqlite", static_cast<double>(fs::file_size(index)) / 1e6, "MB", "");
  measure_queries(index);
  print_row("list: page of 3000 clips",
            median_ms([&] {
              (void)needed(recordings::read_clip_summaries(index, clips / 2, 3000));
            }),
            "ms",
            "1000 ms");
  const Stopwatch watch;
  (void)needed(recordings::read_library_records(index));
  print_row("all records read", watch.seconds(), "s", "");
  return 0;
}

void measure_queries(const fs::path& index) {
  using recordings::ClipSelector;
  const auto row =
      [&](const char* what,
          const std::function<Result<recordings::ClipSet>(const ClipSelector&)>& select) {
        long found = 0;
        const double ms = median_ms([&] {
          const auto set = select(needed(ClipSelector::open(index)));
          found = std::count(needed(set).begin(), needed(set).end(), true);
        });
        print_row((std::string(what) + ", " + std::to_string(found) + " clips").c_str(),
                  ms,
                  "ms",
                  "100 ms");
      };
  using recordings::Comparison;
  row("label", [](const auto& s) { return s.with_label("content:walk"); });
  row("label part", [](const auto& s) { return s.with_part_of_label("walk"); });
  row("figure", [](const auto& s) {
    return s.with_figure("speed_m_s", Comparison::kGreater, 1.2);
  });
  row("figure rare", [](const auto& s) {
    return s.with_figure("slide_cm_s", Comparison::kGreater, 19.9);
  });
  row("quality", [](const auto& s) { return s.with_quality(Verdict::kPass); });
  row("licence", [](const auto& s) {
    return s.with_text(recordings::ClipText::kLicence, "unknown");
  });
  row("kind",
      [](const auto& s) { return s.with_text(recordings::ClipText::kKind, "bvh"); });
  row("name part", [](const auto& s) {
    return s.with_part_of_text(recordings::ClipText::kName, "walk");
  });
  row("text", [](const auto& s) {
    return s.with_words(std::vector<std::string>{"turn", "left"});
  });
  row("seconds", [](const auto& s) {
    return s.with_number(recordings::ClipNumber::kSeconds, Comparison::kGreater, 3);
  });
  row("frames", [](const auto& s) {
    return s.with_number(recordings::ClipNumber::kFrames, Comparison::kGreater, 100);
  });
  row("event", [](const auto& s) { return s.with_event("left.strike"); });
  row("problem", [](const auto& s) { return s.with_problem("spike"); });
  row("relation",
      [](const auto& s) { return s.with_label("hand_right above head", 0.3); });
  row("origin", [](const auto& s) {
    return s.with_part_of_text(recordings::ClipText::kPath, "take_0001");
  });
  row("body",
      [](const auto& s) { return s.with_text(recordings::ClipText::kBody, "second"); });
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  const int clips = argc > 1 ? std::atoi(argv[1]) : 100'000;
  if (argc > 2 || clips < 1) {
    std::fprintf(stderr, "usage: measure_library_index [CLIPS]\n");
    return 2;
  }
  return marey::run(clips);
}
