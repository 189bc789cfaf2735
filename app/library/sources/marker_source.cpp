// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/marker_source.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/library/sources/source_kind.h"
#include "app/markers/fit_run.h"
#include "app/markers/fit_words.h"
#include "app/markers/marker_event_text.h"
#include "app/shell/console.h"
#include "reconstruct/labels/name_markers.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// The markers of one person.
struct PersonMarkers {
  std::string prefix;  ///< "Bob:"; empty: there is one person.
  std::vector<std::size_t> markers;
};

std::string prefix_of_label(const std::string& label) {
  const std::size_t colon = label.rfind(':');
  return colon == std::string::npos ? std::string() : label.substr(0, colon + 1);
}

/// Returns the persons with enough known labels for a fit; one person if there are not
/// several of them.
std::vector<PersonMarkers> persons_of(const MarkerTracks& tracks) {
  std::vector<PersonMarkers> all;
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    const std::string prefix = prefix_of_label(tracks.labels[m]);
    auto at = std::ranges::find(all, prefix, &PersonMarkers::prefix);
    if (at == all.end()) at = all.insert(all.end(), {prefix, {}});
    at->markers.push_back(m);
  }
  constexpr std::ptrdiff_t kMinKnown = 6;
  std::erase_if(all, [&](const PersonMarkers& person) {
    std::vector<std::string> labels;
    for (const std::size_t m : person.markers) {
      labels.push_back(tracks.labels[m].substr(person.prefix.size()));
    }
    const auto names = reconstruct::name_markers(labels);
    return std::ranges::count_if(names.landmarks, [](const auto* one) {
             return one != nullptr;
           }) < kMinKnown;
  });
  if (all.size() > 1) return all;
  return {{}};
}

/// Returns the markers of one person alone.
recordings::MarkerFile markers_of(const recordings::MarkerFile& file,
                                  const PersonMarkers& person) {
  recordings::MarkerFile out;
  out.axes = file.axes;
  out.notes = file.notes;
  const MarkerTracks& from = file.tracks;
  MarkerTracks& to = out.tracks;
  to.rate = from.rate;
  to.first_frame = from.first_frame;
  to.start_s = from.start_s;
  for (const std::size_t m : person.markers) to.labels.push_back(from.labels[m]);
  to.samples.reserve(from.frames() * to.markers());
  for (std::size_t f = 0; f < from.frames(); ++f) {
    for (const std::size_t m : person.markers) to.samples.push_back(from.at(f, m));
  }
  return out;
}

/// Returns the events of a person by frame; those outside the frames are left out.
std::vector<ClipEvent> events_of(const recordings::MarkerFile& file,
                                 const std::string& person) {
  std::vector<ClipEvent> out;
  const MarkerTracks& tracks = file.tracks;
  const auto frames = static_cast<double>(tracks.frames());
  for (const recordings::MarkerEvent& event : file.events) {
    const bool is_others =
        !person.empty() && !event.subject.empty() && event.subject != person;
    const double frame = std::round((event.time_s - tracks.start_s) * tracks.rate.hz);
    if (is_others || !(frame >= 0.0 && frame < frames)) continue;
    out.push_back({static_cast<int>(frame), text_of_event(event)});
  }
  std::ranges::sort(out, [](const ClipEvent& a, const ClipEvent& b) {
    return std::pair(a.frame, a.name) < std::pair(b.frame, b.name);
  });
  return out;
}

ClipFigure plain_figure(std::string name, double value) {
  return {std::move(name), value, std::nullopt, "", std::nullopt};
}

/// Adds what was measured by repair and fit.
void add_fit_figures(const MarkerTrial& trial, SourceMotion& out) {
  std::size_t removed = 0;
  for (const auto& fault : trial.repair.checked.findings) removed += fault.frames;
  std::size_t filled = 0;
  for (const auto& gap : trial.repair.repaired.gaps) {
    if (gap.method != reconstruct::RepairMethod::kLeftEmpty) filled += gap.frames;
  }
  out.figures.push_back(plain_figure("filled_samples", static_cast<double>(filled)));
  out.figures.push_back(plain_figure("removed_samples", static_cast<double>(removed)));
  out.figures.push_back(plain_figure("residual_mm", 1000.0 * trial.solved->rms_m));
  if (removed + filled == 0) return;
  out.remarks.push_back("repair removed or corrected " + std::to_string(removed) +
                        " marker samples and filled " + std::to_string(filled));
}

/// Replaces options of `marey fit`, which a library does not have.
std::string without_options(std::string text) {
  constexpr std::string_view kOption = "--markers MAP.toml";
  const std::size_t at = text.find(kOption);
  if (at == std::string::npos) return text;
  return text.replace(
      at, kOption.size(), std::string("a ") + kMarkerMapFile + " in its folder");
}

/// Solves the markers of one person.
Result<SourceMotion> solve_person(const fs::path& path,
                                  recordings::MarkerFile file,
                                  const MarkerSourceOptions& options) {
  Console console(ProgressStyle::kKept);
  SourceMotion out;
  out.rates.file_hz = file.tracks.rate.hz;
  // The movement model of the fit depends on the rate.
  if (options.rate_hz) file.tracks.rate.hz = *options.rate_hz;
  FitArguments args;
  args.in = {path};
  std::error_code absent;
  const fs::path subject = path.parent_path() / kMarkerSubjectFile;
  const fs::path map_file = path.parent_path() / kMarkerMapFile;
  if (fs::exists(subject, absent)) args.subject = subject;
  if (fs::exists(map_file, absent)) args.map = map_file;
  FitRun run;
  const auto map = read_fit_givens(args, run);
  if (!map) return map.error();
  auto trial = make_marker_trial(path, path.stem().string(), std::move(file), console);
  if (!trial) return trial.error();
  run.trials.push_back(*std::move(trial));
  if (const Status ok = solve_fit(args, *map, console, run); !ok) return ok.error();
  for (const std::string& note : console.kept_warnings()) out.remarks.push_back(note);
  const std::vector<Finding> poor = assess_fit_run(args, run);
  for (const Finding& finding : assess_run(run)) out.remarks.push_back(finding.message());
  for (const Finding& finding : poor) out.remarks.push_back(finding.message());
  for (std::string& remark : out.remarks) remark = without_options(std::move(remark));
  MarkerTrial& solved = run.trials.front();
  add_fit_figures(solved, out);
  out.motion = std::move(solved.solved->estimate.motion);
  out.uncertainty = std::move(solved.solved->estimate.uncertainty);
  if (!poor.empty()) {
    const int last = static_cast<int>(out.motion.poses.size()) - 1;
    out.problems.push_back({{0, last}, "fit", "", static_cast<double>(poor.size())});
  }
  out.subject = solved.prefix;
  while (out.subject.ends_with(':')) out.subject.pop_back();
  return out;
}

}  // namespace

Result<std::vector<SourceMotion>> solve_marker_source(
    const fs::path& path,
    recordings::MarkerFile file,
    const MarkerSourceOptions& options) {
  // Distances between all markers are computed.
  constexpr std::size_t kMaxMarkers = 2000;
  if (file.tracks.markers() > kMaxMarkers) {
    return bad_input(path.string(),
                     "it has " + std::to_string(file.tracks.markers()) +
                         " markers, but a library solves at most " +
                         std::to_string(kMaxMarkers),
                     "write a file with the markers of the persons alone");
  }
  const std::vector<PersonMarkers> persons = persons_of(file.tracks);
  std::vector<SourceMotion> all;
  std::vector<std::string> failed;
  std::optional<Error> first_error;
  for (const PersonMarkers& person : persons) {
    std::string name = person.prefix;
    while (name.ends_with(':')) name.pop_back();
    std::vector<ClipEvent> events = events_of(file, name);
    const bool is_alone = persons.size() == 1;
    auto markers = is_alone ? std::move(file) : markers_of(file, person);
    auto motion = solve_person(path, std::move(markers), options);
    if (!motion) {
      failed.push_back(name + " is left out: " + motion.error().message());
      if (!first_error) {
        first_error = motion.error();
        first_error->next = without_options(first_error->next);
      }
      continue;
    }
    motion->body = name;
    motion->events = std::move(events);
    all.push_back(*std::move(motion));
  }
  if (all.empty()) return *first_error;
  for (std::string& one : failed) all.front().remarks.push_back(std::move(one));
  return all;
}

Result<std::vector<SourceMotion>> read_marker_source(const fs::path& path,
                                                     const MarkerSourceOptions& options) {
  auto file = recordings::read_markers(path);
  if (!file) return file.error();
  return solve_marker_source(path, *std::move(file), options);
}

}  // namespace marey::app
