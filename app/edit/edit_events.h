// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "edit/find/find_loops.h"
#include "edit/jump/jump_graph.h"
#include "edit/render.h"

#include "app/edit/edit_inputs.h"
#include "app/edit/edit_outputs.h"
#include "core/base/frame_range.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"
#include "core/finding.h"

namespace marey::app {

/// The sender of a request, for the answer.
struct EditAsker {
  std::uint64_t page = 0;  ///< Number of the page.
  std::string about{};     ///< Type of the request.
  std::string id{};        ///< Chosen by the page.
};

/// State of the rendering of a revision.
struct EditProgress {
  enum class State { kRendering, kDone, kFailed };
  int revision = 0;
  int done = 0;  ///< Operations.
  int total = 0;
  State state = State::kRendering;
  std::optional<int> failed_op;  ///< Index; nullopt: the files of the recipe.
  std::string error;
};

/// A rendered recipe. References are valid during the call that passes it.
struct EditResult {
  int revision = 0;
  const EditRecipe& recipe;
  const EditFiles& files;
  const edit::Rendered& rendered;
  std::vector<EditFigures> figures;  ///< Empty in previews.
  std::vector<Finding> findings;
};

/// Parts of a preview that are sent.
struct PreviewParts {
  std::optional<int> until{};        ///< Number of operations; nullopt: all.
  std::optional<int> output{};       ///< Index; nullopt: all.
  std::optional<FrameRange> span{};  ///< nullopt: all frames.
};

struct EditLoops {
  int revision = 0;
  std::optional<int> until;
  int output = 0;
  double rate_hz = 0.0;
  std::vector<edit::LoopCandidate> candidates;
  std::optional<edit::LoopMap> map;
};

struct EditJump {
  int revision = 0;
  int op = 0;  ///< Index of the operation.
  int output = 0;
  int number = 1;  ///< JumpOp::jump.
  edit::JumpGraph graph;
};

struct EditExported {
  int revision = 0;
  std::vector<std::filesystem::path> files;
  std::vector<Finding> findings;
};

class EditSession;

/// Receives the results of an EditSession, on its worker's thread unless stated, one at a
/// time.
class EditListener {
 public:
  EditListener() = default;
  virtual ~EditListener() = default;
  EditListener(const EditListener&) = delete;
  EditListener& operator=(const EditListener&) = delete;

  /// There is a new revision. On the thread of the session, before its rendering starts.
  virtual void on_revision(const EditSession& session) = 0;
  virtual void on_progress(const EditProgress& progress) = 0;
  /// A revision is rendered as a whole.
  virtual void on_rendered(const EditResult& result) = 0;
  virtual void on_preview(const EditAsker& asker,
                          const PreviewParts& parts,
                          const EditResult& result) = 0;
  virtual void on_loops(const EditAsker& asker, const EditLoops& loops) = 0;
  virtual void on_jump(const EditAsker& asker, const EditJump& jump) = 0;
  virtual void on_exported(const EditAsker& asker, const EditExported& exported) = 0;
  /// A request of a page failed. Also on the thread of the session.
  virtual void on_failed(const EditAsker& asker, const Error& error) = 0;
};

}  // namespace marey::app
