// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/render.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include "edit/apply_op.h"
#include "edit/state/op_error.h"

#include "core/base/assert.h"

namespace marey::edit {
namespace {

/// Operations at the end of a recipe whose results are all kept.
constexpr std::size_t kKeptAtEnd = 32;
/// Results of earlier operations that are kept, at equal distances.
constexpr std::size_t kKeptBefore = 64;

/// Returns true if the cache should hold the result of an operation. All of a usual
/// recipe; a part of a long one, whose results would take longer to copy than to make.
bool is_kept(std::size_t index, std::size_t count) {
  const std::size_t stride = (count + kKeptBefore - 1) / kKeptBefore;
  return index + kKeptAtEnd >= count || (index + 1) % stride == 0;
}

/// Motions before the next operation, and the number of operations that are done.
struct RenderStart {
  const Rendered* known = nullptr;  ///< A result in the cache.
  std::size_t done = 0;
};

RenderStart start_of(const RenderOptions& options, std::size_t count) {
  if (options.cache == nullptr || options.keys.empty()) return {};
  for (std::size_t done = count; done > 0; --done) {
    const Rendered* known = options.cache->find(options.keys[done - 1]);
    if (known != nullptr) return {known, done};
  }
  return {};
}

/// Applies an operation to motions that are kept elsewhere.
Status apply_to_kept(const OpContext& context,
                     std::span<const EditState> states,
                     Rendered& result) {
  std::vector<EditState> made;
  for (const EditState& state : states) {
    OpReport report;
    auto parts = apply_op(context, state, report);
    if (!parts) return parts.error();
    result.reports.push_back(std::move(report));
    std::move(parts->begin(), parts->end(), std::back_inserter(made));
  }
  result.outputs = std::move(made);
  return Done{};
}

/// Applies an operation to the motions of the result, whose memory it may use.
Status apply_to_own(const OpContext& context, Rendered& result) {
  std::vector<EditState> made;
  for (EditState& state : result.outputs) {
    OpReport report;
    auto parts = apply_op(context, std::move(state), report);
    if (!parts) return parts.error();
    state = EditState{};
    result.reports.push_back(std::move(report));
    std::move(parts->begin(), parts->end(), std::back_inserter(made));
  }
  result.outputs = std::move(made);
  return Done{};
}

std::size_t bytes_of(const OpReport& report) {
  std::size_t bytes = sizeof(OpReport) + report.name.capacity();
  for (const auto& [name, value] : report.figures) {
    bytes += sizeof(std::pair<std::string, double>) + name.capacity();
  }
  for (const Finding& finding : report.findings) {
    bytes += sizeof(Finding) + finding.id.capacity() + finding.where.capacity() +
             finding.cause.capacity() + finding.next.capacity();
  }
  return bytes;
}

/// Returns true if an operation that is on joins this source.
bool is_joined(const EditRecipe& recipe, const std::string& source) {
  return std::any_of(recipe.ops.begin(), recipe.ops.end(), [&](const EditOp& op) {
    const auto* splice = std::get_if<SpliceOp>(&op.parameters);
    return splice != nullptr && !op.off && splice->source == source;
  });
}

/// Applies the operations from start.done on. `own` is the motion of the first operation
/// if it is the caller's; otherwise that of start.known or of the inputs.
Result<Rendered> render_from(const EditRecipe& recipe,
                             const EditInputs& inputs,
                             const RenderOptions& options,
                             const Progress& progress,
                             std::optional<EditState> own) {
  MAREY_ASSERT(options.keys.empty() || options.keys.size() == recipe.ops.size());
  const std::size_t count =
      std::min(options.until.value_or(recipe.ops.size()), recipe.ops.size());
  const RenderStart start = own ? RenderStart{} : start_of(options, count);
  Rendered out;
  // Motions that are not copied, because the next operation makes others.
  std::span<const EditState> kept;
  if (own) {
    out.outputs.push_back(*std::move(own));
    own.reset();
  } else if (start.known != nullptr) {
    kept = start.known->outputs;
    out.reports = start.known->reports;
  } else {
    const auto source = inputs.sources.find(recipe.sources.front().id);
    MAREY_ASSERT(source != inputs.sources.end());
    kept = {&source->second, 1};
  }
  if (progress && start.done > 0) {
    progress(static_cast<int>(start.done), static_cast<int>(count));
  }
  for (std::size_t i = start.done; i < count; ++i) {
    const EditOp& op = recipe.ops[i];
    if (options.is_cancelled && options.is_cancelled()) {
      return bad_input(options.recipe_file, "the rendering was stopped", "");
    }
    if (!op.off) {
      const OpContext context{op, static_cast<int>(i), inputs};
      const Status ok =
          kept.empty() ? apply_to_own(context, out) : apply_to_kept(context, kept, out);
      if (!ok) return at_recipe_line(ok.error(), op, i, options.recipe_file);
      kept = {};
      if (options.cache != nullptr && !options.keys.empty() && is_kept(i, count)) {
        const Rendered* stored = options.cache->store(options.keys[i], std::move(out));
        if (stored != nullptr) {
          kept = stored->outputs;
          out = Rendered{{}, stored->reports};
        }
      }
    }
    if (progress) progress(static_cast<int>(i + 1), static_cast<int>(count));
  }
  if (!kept.empty()) out.outputs.assign(kept.begin(), kept.end());
  return out;
}

}  // namespace

const Rendered* EditCache::find(const std::string& key) {
  const auto entry = std::find_if(
      entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
  if (entry == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, entry);
  return &entries_.front().result;
}

const Rendered* EditCache::store(const std::string& key, Rendered&& result) {
  if (const Rendered* known = find(key); known != nullptr) return known;
  std::size_t bytes = 0;
  for (const EditState& state : result.outputs) bytes += bytes_of(state);
  for (const OpReport& report : result.reports) bytes += bytes_of(report);
  if (bytes > max_bytes_) return nullptr;
  entries_.push_front({key, std::move(result), bytes});
  bytes_ += bytes;
  while (bytes_ > max_bytes_) {
    bytes_ -= entries_.back().bytes;
    entries_.pop_back();
  }
  return &entries_.front().result;
}

std::size_t bytes_of(const EditState& state) {
  const std::size_t joints = state.motion.skeleton.joints.size();
  const std::size_t frame =
      sizeof(Pose) + joints * sizeof(glm::dquat) + sizeof(FrameLineage) +
      (state.uncertainty.empty() ? 0 : joints * sizeof(JointUncertainty)) +
      state.annotations.curves.size() * sizeof(double);
  std::size_t others = state.lineage.touches.size() * sizeof(LineageTouch) +
                       state.contact_edits.size() * sizeof(ContactEdit);
  for (const Annotation& note : state.annotations.notes) {
    others += sizeof(Annotation) + note.text.capacity();
  }
  return state.motion.poses.size() * frame + others;
}

Result<Rendered> render(const EditRecipe& recipe,
                        const EditInputs& inputs,
                        const RenderOptions& options,
                        const Progress& progress) {
  return render_from(recipe, inputs, options, progress, std::nullopt);
}

Result<Rendered> render(const EditRecipe& recipe,
                        EditInputs&& inputs,
                        const RenderOptions& options,
                        const Progress& progress) {
  EditInputs used = std::move(inputs);
  const std::string& first = recipe.sources.front().id;
  const bool has_cache = options.cache != nullptr && !options.keys.empty();
  std::optional<EditState> own;
  if (!has_cache && !is_joined(recipe, first)) {
    const auto source = used.sources.find(first);
    MAREY_ASSERT(source != used.sources.end());
    own = std::move(source->second);
    used.sources.erase(source);
  }
  return render_from(recipe, used, options, progress, std::move(own));
}

}  // namespace marey::edit
