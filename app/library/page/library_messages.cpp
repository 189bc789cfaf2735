// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/library_messages.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

namespace marey::app {
namespace {

using ClipJson = nlohmann::ordered_json;

constexpr std::size_t kMaxRowLabels = 12;

std::string one_line(const ClipJson& json) {
  return json.dump(-1, ' ', false, ClipJson::error_handler_t::replace);
}

ClipJson answer_to(const LibraryAsker& asker, const char* type) {
  return {{"type", type}, {"id", asker.id}, {"revision", asker.revision}};
}

template <class List, class One>
ClipJson list_json(const List& list, const One& one) {
  ClipJson out = ClipJson::array();
  for (const auto& item : list) out.push_back(one(item));
  return out;
}

ClipJson span_json(const std::optional<FrameRange>& span) {
  if (!span) return {};
  return ClipJson::array({span->first, span->last});
}

std::span<const std::string> first_labels(const std::vector<std::string>& labels) {
  return std::span(labels).first(std::min(labels.size(), kMaxRowLabels));
}

ClipJson row_json(const recordings::ClipSummary& clip) {
  return {{"clip", clip.number},
          {"clip_id", clip.clip_id},
          {"name", clip.name},
          {"seconds", clip.duration_s},
          {"rate_hz", clip.rate_hz},
          {"quality", name(clip.quality)},
          {"licence", clip.licence},
          {"subject", clip.subject},
          {"split", clip.split},
          {"labels", first_labels(clip.labels)},
          {"found_labels", first_labels(clip.found_labels)}};
}

ClipJson provenance_json(const Provenance& from) {
  return {{"source_id", from.source_id},
          {"path", from.path},
          {"kind", from.kind},
          {"licence", from.licence},
          {"origin", from.origin},
          {"commit", from.commit},
          {"subject", from.subject},
          {"attribution", from.attribution}};
}

/// Limits are null for a figure that is only reported, or that this version of marey does
/// not have.
ClipJson figure_json(const ClipFigure& figure, const library::QualityLimits& limits) {
  ClipJson out{{"name", figure.name},
               {"value", figure.value},
               {"verdict", figure.verdict ? ClipJson(name(*figure.verdict)) : ClipJson()},
               {"joint", figure.joint},
               {"frames", span_json(figure.frames)},
               {"kind", ""},
               {"warn", nullptr},
               {"fail", nullptr}};
  for (const library::FigureRule& rule : limits.rules()) {
    if (rule.figure != figure.name) continue;
    out["kind"] = rule.kind;
    if (!rule.is_judged) continue;
    out["warn"] = rule.warn;
    out["fail"] = rule.fail;
  }
  return out;
}

ClipJson neighbour_json(const ShownNeighbour& shown, const ClipListing& listing) {
  ClipJson out = row_json(listing[shown.neighbour.clip]);
  out["distance"] = shown.neighbour.distance;
  out["start_s"] = shown.start_s;
  out["end_s"] = shown.end_s;
  out["trouble"] = shown.trouble;
  return out;
}

/// Adds the parts of a record that have places in the clip.
void add_places(const ClipRecord& record,
                const library::QualityLimits& limits,
                ClipJson& out) {
  out["figures"] = list_json(record.figures, [&](const ClipFigure& figure) {
    return figure_json(figure, limits);
  });
  out["problems"] = list_json(record.problems, [](const ClipProblem& one) {
    return ClipJson{{"frames", span_json(one.frames)},
                    {"kind", one.kind},
                    {"joint", one.joint},
                    {"value", one.value}};
  });
  out["labels"] = list_json(record.labels, [](const ClipLabel& one) {
    return ClipJson{{"start_s", one.start_s},
                    {"end_s", one.end_s},
                    {"text", one.text},
                    {"by", one.by},
                    {"certainty", one.certainty}};
  });
  out["events"] = list_json(record.events, [](const ClipEvent& one) {
    return ClipJson{{"frame", one.frame}, {"name", one.name}};
  });
}

}  // namespace

std::string library_page_json(const LibraryState& state) {
  return one_line({{"type", "library"},
                   {"version", 1},
                   {"revision", state.revision},
                   {"name", state.name},
                   {"folder", state.folder},
                   {"clips", state.clips},
                   {"failed", state.failed},
                   {"trouble", state.trouble},
                   {"query", state.query}});
}

std::string clips_json(const LibraryAsker& asker,
                       const ClipListing& listing,
                       const FoundClips& found,
                       int offset,
                       std::span<const int> rows) {
  ClipJson out = answer_to(asker, "clips");
  out["offset"] = offset;
  out["found"] = found.numbers.size();
  out["counts"] = {
      {"pass", found.counts[0]}, {"warn", found.counts[1]}, {"fail", found.counts[2]}};
  out["remarks"] = found.remarks;
  out["rows"] = list_json(rows, [&](int number) { return row_json(listing[number]); });
  return one_line(out);
}

std::string drawing_json(int clip, const ClipDrawing& drawing) {
  const ClipJson poses = list_json(drawing.poses, [](const DrawnPose& pose) {
    ClipJson points = ClipJson::array();
    for (const DrawnPoint& point : pose) {
      points.push_back(point.x);
      points.push_back(point.y);
    }
    return points;
  });
  return one_line({{"clip", clip}, {"poses", poses}});
}

std::string missing_drawing_json(int clip) {
  return one_line({{"clip", clip}, {"poses", nullptr}});
}

std::string drawings_json(const LibraryAsker& asker,
                          std::span<const std::string> drawings) {
  // Joined as text: drawings are kept as text, and parsing them would cost more than
  // making them.
  std::string out = one_line(answer_to(asker, "drawings"));
  out.pop_back();
  out += ",\"drawings\":[";
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    if (i > 0) out += ',';
    out += drawings[i];
  }
  out += "]}";
  return out;
}

std::string shown_clip_json(const LibraryAsker& asker,
                            const ShownClip& clip,
                            const ClipListing& listing,
                            const library::QualityLimits& limits) {
  const ClipRecord& record = clip.record;
  ClipJson out = answer_to(asker, "clip");
  out["row"] = row_json(listing[clip.number]);
  out["frames"] = {record.first_frame, record.last_frame};
  out["rate_by"] = name(record.rate_by);
  out["body"] = record.body;
  out["object_key"] = record.object_key;
  out["duplicate_of"] = record.duplicate_of;
  out["mirror_of"] = record.mirror_of;
  out["provenance"] = provenance_json(record.provenance);
  add_places(record, limits, out);
  out["scene"] = clip.scene.empty() ? ClipJson() : ClipJson::parse(clip.scene);
  out["frame_step"] = clip.frame_step;
  out["trouble"] = clip.trouble;
  out["mirrored"] = clip.is_mirrored;
  out["compared_s"] = clip.compared_s;
  out["neighbours"] = list_json(clip.neighbours, [&](const ShownNeighbour& one) {
    return neighbour_json(one, listing);
  });
  out["neighbour_trouble"] = clip.neighbour_trouble;
  return one_line(out);
}

std::string stored_json(const LibraryAsker& asker, const std::string& file) {
  ClipJson out = answer_to(asker, "stored");
  out["about"] = asker.about;
  out["file"] = file;
  return one_line(out);
}

std::string outdated_json(const LibraryAsker& asker) {
  ClipJson out = answer_to(asker, "outdated");
  out["about"] = asker.about;
  return one_line(out);
}

std::string library_error_json(const LibraryAsker& asker, const std::string& text) {
  return one_line(
      {{"type", "error"}, {"id", asker.id}, {"about", asker.about}, {"text", text}});
}

}  // namespace marey::app
