// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/c3d_markers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

/// Maximum number of frames passed to the AxisFinder.
constexpr std::int64_t kLookedAt = 500;

/// Passes frames of the whole file to the finder.
Status look(C3dReader reader,
            const C3dMarkers& markers,
            bool trust_all,
            AxisFinder& finder) {
  const std::int64_t step = std::max<std::int64_t>(1, reader.info().frames / kLookedAt);
  C3dFrame frame;
  std::vector<glm::dvec3> seen;
  for (std::int64_t number = 0;; ++number) {
    const Result<bool> more = reader.next(frame);
    if (!more) return more.error();
    if (!*more) return Done{};
    if (number % step != 0) continue;
    seen.clear();
    for (const std::size_t point : markers.point) {
      const auto p = c3d_position(reader.info(), &frame.points[4 * point], trust_all);
      if (p) seen.push_back(*p);
    }
    finder.add_frame(seen);
  }
}

/// Marks samples as repaired. In files with residuals or cameras, samples without both
/// were filled (User Guide, "3D point residuals").
void mark_repaired(MarkerTracks& tracks) {
  const auto has_residual = [](const std::optional<MarkerSample>& sample) {
    return sample && (sample->sigma_m > 0.0F || sample->cameras != 0);
  };
  if (std::none_of(tracks.samples.begin(), tracks.samples.end(), has_residual)) return;
  for (std::optional<MarkerSample>& sample : tracks.samples) {
    if (sample && !has_residual(sample)) sample->source = Source::kRepaired;
  }
}

void note_unseen(const MarkerTracks& tracks, std::vector<std::string>& notes) {
  std::vector<bool> seen(tracks.markers(), false);
  for (std::size_t i = 0; i < tracks.samples.size(); ++i) {
    if (tracks.samples[i]) seen[i % tracks.markers()] = true;
  }
  const auto never = std::count(seen.begin(), seen.end(), false);
  if (never > 0) {
    notes.push_back(std::to_string(never) + " of " + std::to_string(tracks.markers()) +
                    " markers are never seen");
  }
}

/// `open` returns a new reader at the first frame on each call.
template <class Open>
Result<MarkerFile> read_all(const Open& open, const MarkerReadOptions& options) {
  Result<C3dReader> reader = open();
  if (!reader) return reader.error();
  const C3dInfo& info = reader->info();
  MarkerFile file;
  file.notes = info.notes;
  if (has_rotations(info)) {
    file.notes.emplace_back(
        "the rotations behind the frames (group ROTATION) are not read, nor written "
        "again");
  }
  C3dMarkers markers = markers_of(info, file.notes);

  Result<C3dReader> second = open();
  if (!second) return second.error();
  const Result<bool> trust_all = all_marked_unseen(*std::move(second));
  if (!trust_all) return trust_all.error();
  if (*trust_all) {
    file.notes.emplace_back(
        "every sample is marked as not seen, though there are positions; they are taken");
  }
  AxisFinder finder;
  Result<C3dReader> third = open();
  if (!third) return third.error();
  if (Status ok = look(*std::move(third), markers, *trust_all, finder); !ok) {
    return ok.error();
  }
  file.axes = axes_of(info, finder, options, file.notes);
  file.events = events_of(info);

  MarkerTracks& tracks = file.tracks;
  tracks.labels = std::move(markers.labels);
  tracks.rate = FrameRate{info.rate_hz};
  tracks.first_frame = info.first_frame;
  tracks.start_s = (info.first_frame - 1) / info.rate_hz;
  if (markers.point.empty()) {
    file.notes.emplace_back("there are no markers in the file");
    return file;
  }
  // The frames are checked to be in the file, so this is at most a few times its size.
  tracks.samples.reserve(markers.point.size() * static_cast<std::size_t>(info.frames));
  C3dFrame frame;
  for (;;) {
    const Result<bool> more = reader->next(frame);
    if (!more) return more.error();
    if (!*more) break;
    for (const std::size_t point : markers.point) {
      tracks.samples.push_back(
          c3d_sample(info, file.axes, &frame.points[4 * point], *trust_all));
    }
  }
  mark_repaired(tracks);
  note_unseen(tracks, file.notes);
  return file;
}

}  // namespace

Result<MarkerFile> read_c3d_markers(const std::filesystem::path& path,
                                    const MarkerReadOptions& options) {
  return read_all([&] { return C3dReader::open(path); }, options);
}

Result<MarkerFile> parse_c3d_markers(std::string bytes,
                                     const std::string& file,
                                     const MarkerReadOptions& options) {
  return read_all([&] { return C3dReader::of_bytes(bytes, file); }, options);
}

}  // namespace marey::recordings
