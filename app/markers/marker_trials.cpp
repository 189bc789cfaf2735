// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/marker_trials.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <utility>

#include "core/base/parallel.h"
#include "reconstruct/labels/name_markers.h"
#include "reconstruct/tracks/find_marker_faults.h"
#include "reconstruct/tracks/repair_gaps.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Adds up the progress of the workers of one stage.
class JointProgress {
 public:
  JointProgress(const Progress& sink, int total) : sink_(sink), total_(total) {}

  void add(int done) {
    const std::scoped_lock lock(mutex_);
    done_ += done;
    if (sink_) sink_(done_, total_);
  }

 private:
  const Progress& sink_;
  int total_;
  int done_ = 0;
  std::mutex mutex_;
};

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

/// Returns a unique folder name for every trial.
std::vector<std::string> names_of(std::span<const fs::path> paths) {
  // Names of other results in the same folder.
  std::set<std::string> taken{"subject.toml", "fit.json", "fit.html"};
  std::vector<std::string> names;
  for (const fs::path& path : paths) {
    std::string stem = path.stem().string();
    if (stem.empty() || stem == "." || stem == "..") stem = "trial";
    names.push_back(stem);
  }
  const std::set<std::string> stems(names.begin(), names.end());
  for (std::string& name : names) {
    const std::string stem = name;
    for (int number = 2; !taken.insert(name).second; ++number) {
      const std::string ending = std::string("-").append(std::to_string(number));
      name = stem + ending;
      // Another file may have this name already.
      if (stems.contains(name)) name += ending;
    }
  }
  return names;
}

Status check_paths(std::span<const fs::path> paths,
                   std::span<const std::string> names,
                   const fs::path& out) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!is_same_file(paths[i], paths[j])) continue;
      return bad_input(paths[i].string(), "this file is given twice", "name it once");
    }
    for (const std::string& name : names) {
      for (const char* result : {"markers.c3d", "markers.trc"}) {
        if (!is_same_file(paths[i], out / name / result)) continue;
        return bad_input(paths[i].string(),
                         "the results would be written over this file",
                         "choose another folder with --out");
      }
    }
  }
  return Done{};
}

/// Removes the subject's name from the labels. It may differ between the recordings of
/// one subject: "Bob_static:LASI", "Bob:LASI".
void remove_subject_prefix(MarkerTrial& trial, Console& console) {
  const std::vector<std::string>& labels = trial.repair.as_read.labels;
  const reconstruct::MarkerNames names = reconstruct::name_markers(labels);
  for (const std::string& note : names.notes) {
    console.warn(trial.path.string() + ": " + note);
  }
  // The rest of the common prefix is the same in all recordings and is kept.
  trial.prefix = names.prefix.substr(0, names.prefix.rfind(':') + 1);
  trial.labels = labels;
  std::set<std::string> taken(labels.begin(), labels.end());
  for (std::string& label : trial.labels) {
    if (!label.starts_with(trial.prefix)) continue;
    std::string rest = label.substr(trial.prefix.size());
    if (!rest.empty() && taken.insert(rest).second) label = std::move(rest);
  }
}

bool is_any_seen(const MarkerTracks& tracks) {
  return std::any_of(tracks.samples.begin(), tracks.samples.end(), [](const auto& s) {
    return s.has_value();
  });
}

}  // namespace

Result<MarkerTrial> make_marker_trial(const fs::path& path,
                                      std::string name,
                                      recordings::MarkerFile file,
                                      Console& console) {
  for (const std::string& note : file.notes) {
    console.warn(path.string() + ": " + note);
  }
  if (!is_any_seen(file.tracks)) {
    return bad_input(path.string(),
                     "no marker is seen in any frame",
                     "leave the file out, or check it in the program that wrote it");
  }
  MarkerTrial trial;
  trial.name = std::move(name);
  trial.path = path;
  trial.repair.name = path.filename().string();
  trial.repair.as_read = std::move(file.tracks);
  file.tracks = {};
  remove_subject_prefix(trial, console);
  trial.file = std::move(file);
  return trial;
}

Result<std::vector<MarkerTrial>> read_trials(std::span<const fs::path> paths,
                                             const recordings::MarkerReadOptions& options,
                                             const fs::path& out,
                                             Console& console) {
  const std::vector<std::string> names = names_of(paths);
  if (const Status ok = check_paths(paths, names, out); !ok) return ok.error();
  std::vector<MarkerTrial> trials;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    auto read = recordings::read_markers(paths[i], options);
    if (!read) return read.error();
    auto trial = make_marker_trial(paths[i], names[i], *std::move(read), console);
    if (!trial) return trial.error();
    if (names[i] != paths[i].stem().string()) {
      console.say(paths[i].string() + ": its results are in " +
                  (out / names[i]).string());
    }
    trials.push_back(*std::move(trial));
  }
  return trials;
}

std::vector<MarkerTracks> repair_trials(std::vector<MarkerTrial>& trials,
                                        const Progress& progress) {
  std::vector<MarkerTracks> checked(trials.size());
  const bool alone = trials.size() == 1;
  JointProgress all(progress, static_cast<int>(trials.size()));
  in_parallel(trials.size(), 0, [&](std::size_t i) {
    Repair& repair = trials[i].repair;
    repair.checked = reconstruct::find_marker_faults(repair.as_read);
    reconstruct::RepairOptions options;
    options.threads = alone ? 0 : 1;
    repair.repaired = reconstruct::repair_gaps(
        repair.checked.tracks, options, alone ? progress : Progress{});
    checked[i] = std::move(repair.checked.tracks);
    checked[i].labels = repair.repaired.tracks.labels = trials[i].labels;
    repair.checked.tracks = {};
    if (!alone) all.add(1);
  });
  return checked;
}

void solve_trials(const Body& body,
                  std::vector<MarkerTrial>& trials,
                  const Progress& progress) {
  std::size_t frames = 0;
  for (const MarkerTrial& trial : trials) frames += trial.repair.as_read.frames();
  JointProgress all(progress, static_cast<int>(frames));
  in_parallel(trials.size(), 0, [&](std::size_t i) {
    const MarkerTracks& tracks = trials[i].repair.repaired.tracks;
    int reported = 0;
    const auto report = [&](int done, int) {
      all.add(done - std::exchange(reported, done));
    };
    trials[i].solved = reconstruct::solve_markers(body, tracks, {}, report);
    // A trial that cannot be solved has reported no progress.
    if (!trials[i].solved) report(static_cast<int>(tracks.frames()), 0);
  });
}

std::size_t frames_with_markers(const MarkerTrial& trial) {
  const MarkerTracks& tracks = trial.repair.as_read;
  std::size_t count = 0;
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      if (!tracks.at(f, m)) continue;
      ++count;
      break;
    }
  }
  return count;
}

}  // namespace marey::app
