// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_messages.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/edit/edit_output_json.h"
#include "app/edit/edit_patch.h"
#include "recordings/edit/edit_recipe_file.h"

namespace marey::app {
namespace {

using MessageJson = nlohmann::ordered_json;

std::string message_text(const MessageJson& json) {
  return json.dump(-1, ' ', false, MessageJson::error_handler_t::replace);
}

template <class T>
MessageJson or_null_json(const std::optional<T>& value) {
  return value ? MessageJson(*value) : MessageJson();
}

MessageJson op_json(const EditOp& op) {
  std::string versioned(name(op.parameters));
  versioned += "@" + std::to_string(op.version);
  return {{"do", versioned},
          {"off", op.off},
          {"text", recordings::edit_op_text(op)},
          {"keys", MessageJson::parse(op_keys_json(op))}};
}

MessageJson source_json(const EditSourceFacts& source) {
  return {{"id", source.id},
          {"file", source.file},
          {"frames", source.frames},
          {"rate_hz", source.rate_hz}};
}

const char* edge_name(edit::LoopEdge edge) {
  switch (edge) {
    case edit::LoopEdge::kLeftStrike:
      return "left_strike";
    case edit::LoopEdge::kRightStrike:
      return "right_strike";
    case edit::LoopEdge::kNone:
      return "none";
  }
  return "none";
}

MessageJson map_json(const edit::LoopMap& map) {
  MessageJson out{{"cells", map.cells}, {"cell_frames", map.cell_frames}};
  MessageJson distances = MessageJson::array();
  for (const float distance_m : map.distance_m) {
    distances.push_back(std::lround(1e3 * static_cast<double>(distance_m)));
  }
  out["distance_mm"] = std::move(distances);
  return out;
}

const char* state_name(EditProgress::State state) {
  switch (state) {
    case EditProgress::State::kRendering:
      return "rendering";
    case EditProgress::State::kDone:
      return "done";
    case EditProgress::State::kFailed:
      return "failed";
  }
  return "failed";
}

}  // namespace

std::string revision_json(const EditSession& session) {
  const EditRevision& revision = session.revision();
  MessageJson ops = MessageJson::array();
  for (const EditOp& op : session.recipe().ops) ops.push_back(op_json(op));
  MessageJson sources = MessageJson::array();
  for (const auto& source : session.sources()) sources.push_back(source_json(source));
  return message_text({{"type", "revision"},
                       {"revision", revision.number},
                       {"parent", revision.parent},
                       {"cause", std::string(name(revision.cause))},
                       {"sha256", revision.sha256},
                       {"name", session.recipe().name},
                       {"recipe_file", session.recipe_file().filename().string()},
                       {"recipe_text", session.recipe_text()},
                       {"sources", std::move(sources)},
                       {"avatars", session.avatars()},
                       {"ops", std::move(ops)},
                       {"undo_possible", session.can_undo()},
                       {"redo_possible", session.can_redo()}});
}

std::string progress_json(const EditProgress& progress) {
  return message_text({{"type", "progress"},
                       {"revision", progress.revision},
                       {"done", progress.done},
                       {"total", progress.total},
                       {"state", state_name(progress.state)},
                       {"op", or_null_json(progress.failed_op)},
                       {"error", progress.error}});
}

std::string accepted_json(const EditAsker& asker, int revision) {
  return message_text({{"type", "accepted"}, {"id", asker.id}, {"revision", revision}});
}

std::string stale_json(const EditAsker& asker, int base_revision, int newest) {
  return message_text({{"type", "stale"},
                       {"id", asker.id},
                       {"about", asker.about},
                       {"base_revision", base_revision},
                       {"revision", newest}});
}

std::string edit_error_json(const EditAsker& asker, const std::string& text) {
  return message_text(
      {{"type", "error"}, {"id", asker.id}, {"about", asker.about}, {"text", text}});
}

std::string loops_json(const EditAsker& asker, const EditLoops& loops) {
  MessageJson candidates = MessageJson::array();
  for (const edit::LoopCandidate& loop : loops.candidates) {
    candidates.push_back({{"first", loop.first},
                          {"last", loop.last},
                          {"first_s", loop.first / loops.rate_hz},
                          {"last_s", loop.last / loops.rate_hz},
                          {"period_s", loop.period_frames / loops.rate_hz},
                          {"distance_mm", 1e3 * loop.match.distance_m},
                          {"edge", edge_name(loop.edge)}});
  }
  return message_text({{"type", "loops"},
                       {"id", asker.id},
                       {"revision", loops.revision},
                       {"until", or_null_json(loops.until)},
                       {"output", loops.output},
                       {"candidates", std::move(candidates)},
                       {"map", loops.map ? map_json(*loops.map) : MessageJson()}});
}

std::string exported_json(const EditAsker& asker, const EditExported& exported) {
  MessageJson files = MessageJson::array();
  for (const auto& file : exported.files) files.push_back(file.filename().string());
  return message_text({{"type", "exported"},
                       {"id", asker.id},
                       {"revision", exported.revision},
                       {"files", std::move(files)},
                       {"findings", page_findings_json(exported.findings)}});
}

}  // namespace marey::app
