// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Files that are broken in random places: they are read or refused, without a crash.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/engine/scene_order.h"
#include "recordings/base/atomic_file.h"
#include "recordings/scene/read_scene.h"
#include "recordings/scene/read_trials.h"
#include "tests/support/program/paths.h"

namespace marey::recordings {
namespace {

std::vector<std::string> sample_texts() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(
           testing::source_dir() / "recordings/samples/scenes")) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const auto& path : paths) {
    const Result<std::string> text = read_file(path);
    EXPECT_TRUE(text);
    if (text) texts.push_back(*text);
  }
  return texts;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin + 1));
    begin = end + 1;
  }
  return lines;
}

/// Changes a line: a byte, another line of the samples, a word, or its removal.
std::string mutated(const std::string& text,
                    const std::vector<std::string>& other_lines,
                    std::mt19937_64& random) {
  std::vector<std::string> lines = lines_of(text);
  const std::size_t count = 1 + random() % 3;
  for (std::size_t n = 0; n < count && !lines.empty(); ++n) {
    const std::size_t at = random() % lines.size();
    std::string& line = lines[at];
    switch (random() % 5) {
      case 0:
        // Printable: an installed parser may stop the program at other bytes in a key.
        line[random() % line.size()] = static_cast<char>(32 + random() % 95);
        break;
      case 1:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 2:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at),
                     other_lines[random() % other_lines.size()]);
        break;
      case 3: {
        constexpr std::array<const char*, 10> kValues{
            "nan", "-1", "1e300", "\"\"", "[]", "true", "0", "inf", "{}", "[[1], 2]"};
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos) break;
        line = line.substr(0, equals + 1) + " " + kValues[random() % 10] + "\n";
        break;
      }
      default:
        std::swap(line, lines[random() % lines.size()]);
    }
  }
  std::string result;
  for (const std::string& line : lines) result += line;
  return result;
}

void expect_usable(const Scene& scene) {
  const std::vector<SceneBody> bodies = scene_bodies(scene);
  EXPECT_GE(bodies.size(), 1U);
  EXPECT_EQ(bodies.size(), body_count(scene));
  const auto dependencies = scene_dependencies(scene);
  EXPECT_FALSE(find_cycle(dependencies, bodies.size()));
  std::vector<std::size_t> rounds;
  for (const ActionTime& time : action_times(scene)) {
    EXPECT_LE(time.start_s, time.latest_start_s);
    EXPECT_LE(time.start_s, time.end_s);
    solve_rounds(dependencies, time.start_s, bodies.size(), rounds);
  }
  for (const SceneTarget& target : scene.targets) {
    const auto p = path_at(target.path, 1.5);
    if (p) {
      EXPECT_TRUE(std::isfinite(p->x + p->y + p->z));
    }
  }
}

TEST(SceneMutations, AreReadOrRefused) {
  const std::vector<std::string> texts = sample_texts();
  ASSERT_EQ(texts.size(), 7U);
  std::vector<std::string> all_lines;
  for (const std::string& text : texts) {
    for (const std::string& line : lines_of(text)) all_lines.push_back(line);
  }
  int read = 0;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    std::mt19937_64 random(seed);
    const std::string text = mutated(texts[seed % texts.size()], all_lines, random);
    const Result<Scene> scene = parse_scene(text, "s.toml");
    if (scene) {
      expect_usable(*scene);
      ++read;
    } else {
      EXPECT_EQ(scene.error().code, Errc::kBadInput);
      EXPECT_TRUE(scene.error().where.starts_with("s.toml"));
      EXPECT_FALSE(scene.error().cause.empty() || scene.error().next.empty()) << text;
      ++refused;
    }
    const Result<TrialList> trials = parse_trials(text, "t.toml");
    if (trials) {
      EXPECT_LE(trial_order(*trials).size(), 10'000U);
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace marey::recordings
