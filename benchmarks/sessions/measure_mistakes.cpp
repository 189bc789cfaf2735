// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Counts mistakes in sessions that marey reports with the next step.
//
//   measure_mistakes MAREY SESSION TRUTH OUT [NAME...]
//
// makes every mistake of benchmarks/sessions/session_mistakes.h in SESSION (or those
// called NAME), runs `marey process` on it and prints the exit code, the messages,
// whether they name what to change, and how far the first motion's joints are from TRUTH
// if there are results. "right" is the session as it is. It runs first, unless OUT has
// its results. Tags are searched for in "right" alone; the other runs find them in their
// caches, except where session.toml alone shows the mistake: those must end without a
// search.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/sessions/session_mistakes.h"
#include "core/base/quantile.h"
#include "recordings/motion/motion_tables.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/run_program.h"
#include "tests/support/truth/truth.h"

namespace {

namespace fs = std::filesystem;

using marey::benchmarks::PlainSession;
using marey::benchmarks::SessionMistake;

struct Place {
  fs::path marey;
  fs::path truth;
  fs::path out;
};

/// Detections of a video, as the run of "right" stored them.
struct KeptDetections {
  std::string key;   ///< Without what the trial adds to it.
  std::string rest;  ///< All but the first line.
};
using Kept = std::map<std::pair<std::string, std::string>, KeptDetections>;

void write_text(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// Returns the line of a trial that selects frames; empty if it uses all.
std::string frames_of(const PlainSession::Trial& trial) {
  const auto begin = trial.extra.find("frames = [");
  if (begin == std::string::npos) return {};
  return trial.extra.substr(begin, trial.extra.find(']', begin) + 1 - begin);
}

/// Returns what find_tags() appends to a video's key for its trial.
std::string suffix_of(const PlainSession::Trial& trial) {
  std::string suffix;
  int first = 0;
  int last = 0;
  const std::string frames = frames_of(trial);
  if (std::sscanf(frames.c_str(), "frames = [%d, %d]", &first, &last) == 2) {
    suffix += " frames " + std::to_string(first) + "-" + std::to_string(last);
  }
  const auto fps = trial.extra.find("fps = ");
  if (fps != std::string::npos) {
    suffix += " fps " + std::to_string(std::stod(trial.extra.substr(fps + 6)));
  }
  return suffix;
}

Kept keep(const PlainSession& right, const fs::path& results) {
  Kept kept;
  for (const PlainSession::Trial& trial : right.trials) {
    for (const auto& [camera, video] : trial.videos) {
      std::string text = marey::testing::read_text(results / trial.name / "detections" /
                                                   (camera + ".csv"));
      const auto end = text.find('\n');
      if (end == std::string::npos) continue;
      std::string key = text.substr(0, end);
      const std::string suffix = suffix_of(trial);
      if (key.ends_with(suffix)) key.resize(key.size() - suffix.size());
      kept[{video, frames_of(trial)}] = {key, text.substr(end)};
    }
  }
  return kept;
}

void lay_out(const Kept& kept, const PlainSession& session, const fs::path& results) {
  for (const PlainSession::Trial& trial : session.trials) {
    for (const auto& [camera, video] : trial.videos) {
      const auto found = kept.find({video, frames_of(trial)});
      if (found == kept.end()) continue;
      write_text(results / trial.name / "detections" / (camera + ".csv"),
                 found->second.key + suffix_of(trial) + found->second.rest);
    }
  }
}

/// Returns the messages of a run's standard error: all but progress and results.
std::string messages_in(const std::string& err) {
  std::istringstream lines(err);
  std::string all;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" s") != std::string::npos && line.find('/') != std::string::npos &&
        line.find("error") == std::string::npos &&
        line.find("warning") == std::string::npos && line.find(": ") < 30 &&
        line.ends_with(" s")) {
      continue;  // Progress.
    }
    if (line.starts_with("camera ") || line.starts_with("report: ") ||
        line.starts_with("to see it move") || line.starts_with("cameras are those of") ||
        line.find("frames solved") != std::string::npos) {
      continue;
    }
    all += line + "\n";
  }
  return all;
}

bool names(const std::string& said, const marey::benchmarks::Needed& needed) {
  return std::all_of(needed.begin(), needed.end(), [&](const auto& words) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return said.find(word) != std::string::npos;
    });
  });
}

/// Computes median and 95th percentile over the first motion's joint centres, and the
/// worst joint's median. [mm]
std::optional<std::array<double, 3>> off_by(const Place& place,
                                            const PlainSession& right,
                                            const fs::path& results) {
  const auto trial = std::find_if(right.trials.begin(),
                                  right.trials.end(),
                                  [](const auto& t) { return t.kind == "motion"; });
  if (trial == right.trials.end()) return std::nullopt;
  const auto rows =
      marey::recordings::read_joints_csv(results / trial->name / "joints.csv");
  const auto truth =
      marey::testing::truth_joints(place.truth / trial->name / "truth" / "joints.csv");
  if (!rows || !truth) return std::nullopt;
  std::vector<double> all;
  std::map<std::string, std::vector<double>> by_joint;
  for (const auto& row : *rows) {
    const auto bone = marey::human_bone(row.joint);
    if (!bone || !truth->contains({row.frame, *bone})) continue;
    all.push_back(1e3 * glm::distance(row.p_in_world, truth->at({row.frame, *bone})));
    by_joint[row.joint].push_back(all.back());
  }
  if (all.empty()) return std::nullopt;
  double worst = 0.0;
  for (const auto& [joint, errors] : by_joint) {
    worst = std::max(worst, marey::quantile(errors, 0.5));
  }
  return std::array{marey::quantile(all, 0.5), marey::quantile(all, 0.95), worst};
}

/// Returns the lines of `said` that the session without a mistake does not have.
std::string beyond(const std::string& said, const std::string& usual) {
  std::istringstream lines(said);
  std::string more;
  for (std::string line; std::getline(lines, line);) {
    if (usual.find(line + "\n") == std::string::npos) more += line + "\n";
  }
  return more;
}

/// Returns whether both sessions calibrate the same cameras: they differ in the tags'
/// segments and ids, the stature or later trials alone.
bool has_same_cameras(const PlainSession& right, PlainSession session) {
  const auto sizes = [](const PlainSession& of) {
    std::multiset<double> all;
    for (const PlainSession::Tag& tag : of.tags) all.insert(tag.size_m);
    return all;
  };
  if (sizes(session) != sizes(right)) return false;
  session.tags = right.tags;
  session.stature_m = right.stature_m;
  if (session.trials.size() != right.trials.size()) return false;
  for (std::size_t t = 0; t < right.trials.size(); ++t) {
    const std::string& kind = right.trials[t].kind;
    if (kind == "motion" || kind == "range-of-motion") {
      session.trials[t] = right.trials[t];
    }
  }
  return marey::benchmarks::toml_of(session) == marey::benchmarks::toml_of(right);
}

/// Runs a session with a mistake and prints the result. Returns whether an error or a
/// warning names what to change; for a harmless mistake, whether the exit code is 0.
bool run_one(const Place& place,
             const PlainSession& right,
             const SessionMistake& mistake,
             const Kept& kept) {
  PlainSession session = right;
  if (mistake.make) mistake.make(session);
  const fs::path folder = place.out / mistake.name;
  if (mistake.name != "right") fs::remove_all(folder);
  write_text(folder / "session.toml", marey::benchmarks::toml_of(session));
  if (!mistake.is_in_file) lay_out(kept, session, folder / "out");
  const bool solves =
      mistake.name != "right" && !mistake.is_in_file && has_same_cameras(right, session);
  if (solves) {
    fs::copy_file(place.out / "right" / "out" / "calibration.toml",
                  folder / "out" / "calibration.toml");
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto run = marey::testing::run_program(place.marey,
                                               {solves ? "solve" : "process",
                                                (folder / "session.toml").string(),
                                                "--out",
                                                (folder / "out").string()});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const fs::path usual = place.out / "right" / "said.txt";
  const std::string said =
      mistake.name == "right"
          ? messages_in(run.err)
          : beyond(messages_in(run.err), messages_in(marey::testing::read_text(usual)));
  write_text(folder / "said.txt", run.err);
  const bool searched = mistake.is_in_file && fs::exists(folder / "out");
  const bool is_named = names(said, mistake.named);
  const bool is_silent = run.exit_code == 0 && said.find("warning") == std::string::npos;
  const bool is_right =
      mistake.is_harmless ? run.exit_code == 0 : is_named && !is_silent && !searched;
  std::printf("%-26s %-7s exit %d %6.1f s %s%s%s",
              mistake.name.c_str(),
              solves ? "solve" : "process",
              run.exit_code,
              seconds,
              is_right ? "ok" : "SHORT",
              !mistake.is_harmless && is_silent ? " silent" : "",
              !is_named  ? " not named"
              : searched ? " after a search"
                         : "");
  if (run.exit_code == 0 || run.exit_code == 4) {
    if (const auto off = off_by(place, right, folder / "out")) {
      std::printf("  off by median %.1f p95 %.1f worst joint %.1f mm",
                  (*off)[0],
                  (*off)[1],
                  (*off)[2]);
    }
  }
  std::printf("\n");
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);)
    std::printf("    %s\n", line.c_str());
  std::fflush(stdout);
  return is_right;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: measure_mistakes MAREY SESSION TRUTH OUT [NAME...]\n");
    return 2;
  }
  const Place place{argv[1], argv[3], argv[4]};
  const auto session = marey::recordings::read_session(argv[2]);
  if (!session) {
    std::fprintf(stderr, "%s\n", session.error().message().c_str());
    return 3;
  }
  const std::vector<std::string> wanted(argv + 5, argv + argc);
  const PlainSession right = marey::benchmarks::plain(*session);
  const bool is_known = fs::exists(place.out / "right" / "said.txt");
  const bool fine = is_known || run_one(place, right, {"right", {}, {}, false, true}, {});
  const Kept kept = keep(right, place.out / "right" / "out");
  int made = 0;
  int good = 0;
  for (const SessionMistake& mistake : marey::benchmarks::session_mistakes(right)) {
    if (!wanted.empty() &&
        std::find(wanted.begin(), wanted.end(), mistake.name) == wanted.end()) {
      continue;
    }
    ++made;
    if (run_one(place, right, mistake, kept)) ++good;
  }
  std::printf("%d of %d mistakes are reported and named%s\n",
              good,
              made,
              fine ? "" : "; the session without a mistake is not fine");
  return fine && good == made ? 0 : 1;
}
