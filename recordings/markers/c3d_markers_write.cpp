// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/assert.h"
#include "recordings/markers/c3d_markers.h"

namespace marey::recordings {
namespace {

constexpr double kMaxInteger = 32767.0;

double max_coordinate(const MarkerTracks& tracks, const FileAxes& axes) {
  double max_m = 0.0;
  for (const std::optional<MarkerSample>& sample : tracks.samples) {
    if (!sample) continue;
    const glm::dvec3& p = sample->p_in_world;
    max_m = std::max({max_m, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return max_m * axes.per_metre;
}

double max_sigma(const MarkerTracks& tracks, const FileAxes& axes) {
  float max_m = 0.0F;
  for (const std::optional<MarkerSample>& sample : tracks.samples) {
    if (sample) max_m = std::max(max_m, sample->sigma_m);
  }
  return static_cast<double>(max_m) * axes.per_metre;
}

C3dParameter text_parameter(const char* name, const std::string& text) {
  return {name, "", false, {static_cast<std::uint8_t>(text.size())}, C3dText{text}};
}

C3dParameter count_parameter(const char* name, int count) {
  return {name, "", false, {}, C3dIntegers{static_cast<std::int16_t>(count)}};
}

/// Returns an axis that is perpendicular to `up`, as the screen's right.
FileAxis right_of(FileAxis up) {
  const bool is_x = up == FileAxis::kPlusX || up == FileAxis::kMinusX;
  return is_x ? FileAxis::kPlusY : FileAxis::kPlusX;
}

void put_unit(C3dInfo& info, const FileAxes& axes) {
  put_parameter(info.groups, "POINT", text_parameter("UNITS", axes.unit));
}

void put_up(C3dInfo& info, const FileAxes& axes) {
  put_parameter(info.groups,
                "POINT",
                text_parameter("X_SCREEN", std::string(name(right_of(axes.up)))));
  put_parameter(
      info.groups, "POINT", text_parameter("Y_SCREEN", std::string(name(axes.up))));
}

C3dInfo fresh_info(const MarkerFile& markers, const FileAxes& axes) {
  const MarkerTracks& tracks = markers.tracks;
  C3dInfo info;
  info.points = static_cast<int>(tracks.markers());
  info.frames = static_cast<std::int64_t>(tracks.frames());
  info.rate_hz = tracks.rate.hz;
  // C3D's only clock is the frame number, from 1.
  const double first = std::round(tracks.start_s * tracks.rate.hz) + 1.0;
  info.first_frame = static_cast<int>(std::clamp(first, 1.0, 1e9));
  // The unit of residuals, and the scale for programs that require integers.
  info.scale = std::max({max_coordinate(tracks, axes) / kMaxInteger,
                         max_sigma(tracks, axes) / 255.0,
                         1e-6 * axes.per_metre});
  put_texts(info.groups, "POINT", "LABELS", tracks.labels);
  put_unit(info, axes);
  put_up(info, axes);
  put_parameter(info.groups, "ANALOG", count_parameter("USED", 0));
  put_parameter(info.groups, "FORCE_PLATFORM", count_parameter("USED", 0));
  put_parameter(info.groups, "MANUFACTURER", text_parameter("SOFTWARE", "marey"));
  if (!markers.events.empty()) put_events(info, markers.events);
  return info;
}

Status write_fresh(const std::filesystem::path& path,
                   const MarkerFile& markers,
                   const FileAxes& axes) {
  const MarkerTracks& tracks = markers.tracks;
  const C3dInfo info = fresh_info(markers, axes);
  Result<C3dWriter> writer = C3dWriter::create(path, info);
  if (!writer) return writer.error();
  C3dFrame frame;
  frame.points.resize(4 * tracks.markers());
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      put_c3d_sample(info, axes, tracks.at(f, m), &frame.points[4 * m]);
    }
    writer->append(frame);
  }
  return writer->commit();
}

bool same(const std::optional<MarkerSample>& a, const std::optional<MarkerSample>& b) {
  if (!a || !b) return !a && !b;
  return a->p_in_world == b->p_in_world && a->sigma_m == b->sigma_m &&
         a->cameras == b->cameras;
}

/// Replaces all events of a file. Other lists of the group EVENT have an entry per event,
/// so they are dropped.
void replace_events(C3dInfo& info, const std::vector<MarkerEvent>& events) {
  info.header_events.clear();
  for (C3dGroup& group : info.groups) {
    if (group.name == "EVENT") group.parameters.clear();
  }
  put_events(info, events);
}

/// Writes the frames of the source file with the changed markers.
class SourceCopy {
 public:
  SourceCopy(const MarkerFile& markers, const MarkerWriteOptions& options, bool trust_all)
      : markers_(markers), options_(options), trust_all_(trust_all) {}

  Status write(C3dReader reader,
               const std::filesystem::path& path,
               const std::string& source) {
    const C3dInfo& from = reader.info();
    std::vector<std::string> ignored;
    const C3dMarkers found = markers_of(from, ignored);
    const MarkerTracks& tracks = markers_.tracks;
    if (found.labels != tracks.labels ||
        (!found.labels.empty() && !has_frames(static_cast<std::size_t>(from.frames)))) {
      return bad_input(source,
                       "it holds other markers or frames than those to be written",
                       "give the file that they were read from");
    }
    const C3dInfo to = target_info(from);
    Result<C3dWriter> writer = C3dWriter::create(path, to);
    if (!writer) return writer.error();
    const bool widened = to.numbers != from.numbers;
    const std::size_t skipped = options_.source_first.value_or(0);
    const auto count = static_cast<std::size_t>(to.frames);
    C3dFrame frame;
    for (std::size_t f = 0; f < skipped + count; ++f) {
      const Result<bool> more = reader.next(frame);
      if (!more) return more.error();
      if (!*more) break;
      if (f < skipped) continue;
      replace(from, found, f - skipped, frame);
      if (widened) widen(from, frame);
      writer->append(frame);
    }
    return writer->commit();
  }

 private:
  [[nodiscard]] bool has_frames(std::size_t source_frames) const {
    const std::size_t frames = markers_.tracks.frames();
    const auto& first = options_.source_first;
    if (!first) return frames == source_frames;
    return *first <= source_frames && frames <= source_frames - *first;
  }

  [[nodiscard]] C3dInfo target_info(const C3dInfo& from) const {
    C3dInfo to = from;
    if (options_.source_first) {
      to.first_frame += static_cast<int>(*options_.source_first);
      to.frames = static_cast<std::int64_t>(markers_.tracks.frames());
    }
    if (markers_.events != events_of(from)) replace_events(to, markers_.events);
    if (options_.state_axes) {
      if (markers_.axes.up_from != Evidence::kFile) put_up(to, markers_.axes);
      if (markers_.axes.unit_from != Evidence::kFile) put_unit(to, markers_.axes);
    }
    // It would refer to a section that is not written.
    if (has_rotations(from)) {
      std::erase_if(to.groups, [](const C3dGroup& g) { return g.name == "ROTATION"; });
    }
    // Integers have 32767 steps; larger coordinates need reals.
    const double furthest = max_coordinate(markers_.tracks, markers_.axes);
    if (from.numbers == C3dNumbers::kInteger && furthest > kMaxInteger * from.scale) {
      to.numbers = C3dNumbers::kReal;
    }
    return to;
  }

  void replace(const C3dInfo& info,
               const C3dMarkers& found,
               std::size_t f,
               C3dFrame& frame) {
    for (std::size_t m = 0; m < found.point.size(); ++m) {
      float* words = &frame.points[4 * found.point[m]];
      const auto& sample = markers_.tracks.at(f, m);
      // Unchanged samples keep their words exactly.
      if (same(sample, c3d_sample(info, markers_.axes, words, trust_all_))) continue;
      put_c3d_sample(info, markers_.axes, sample, words);
    }
  }

  static void widen(const C3dInfo& from, C3dFrame& frame) {
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
      if (i % 4 != 3) frame.points[i] *= static_cast<float>(from.scale);
    }
  }

  const MarkerFile& markers_;
  const MarkerWriteOptions& options_;
  bool trust_all_;
};

}  // namespace

Status write_c3d_markers(const std::filesystem::path& path,
                         const MarkerFile& markers,
                         const MarkerWriteOptions& options) {
  MAREY_ASSERT(markers.tracks.rate.hz > 0.0);
  if (!options.source) {
    return write_fresh(path, markers, options.axes.value_or(markers.axes));
  }
  // The source's other points, plates and corners stay in its own axes.
  Result<C3dReader> look = C3dReader::open(*options.source);
  if (!look) return look.error();
  const Result<bool> trust_all = all_marked_unseen(*std::move(look));
  if (!trust_all) return trust_all.error();
  Result<C3dReader> reader = C3dReader::open(*options.source);
  if (!reader) return reader.error();
  return SourceCopy(markers, options, *trust_all)
      .write(*std::move(reader), path, options.source->string());
}

}  // namespace marey::recordings
