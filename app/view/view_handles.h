// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/live_chain/body_handles.h"
#include "app/view/view_recording.h"
#include "core/base/result.h"
#include "core/character.h"
#include "core/constraint.h"
#include "live/page/page_request.h"
#include "live/page/page_scene.h"
#include "live/web/received_text.h"

namespace marey::app {

/// Handles and constraints of the first human figure of a recording. Users drag a hand, a
/// foot, the head or the hips of a frame; the constraints come from a file. The recording
/// itself is not changed.
class ViewHandles {
 public:
  /// `constraints` is a file of constraints, or empty. Without a human figure there are
  /// no handles. Errors: those of reading the file and of check_constraints();
  /// constraints without a human figure.
  [[nodiscard]] static Result<ViewHandles> make(const ViewedRecording& recording,
                                                const std::filesystem::path& constraints);

  /// Returns the constraints for the scene: those of the file, then the handles.
  [[nodiscard]] std::vector<live::PageConstraint> constraints() const;
  /// Returns the index of the figure in the recording.
  [[nodiscard]] std::size_t figure() const { return figure_; }

  /// Stores a drag of a page. Earlier drags of the page in the same frame are kept; those
  /// in another frame are discarded. Stored for the last 16 pages.
  /// Errors (kBadInput), sent to the page: an unknown handle; an unknown or missing
  /// frame.
  [[nodiscard]] Status drag(live::ClientId client, const live::DragRequest& drag);
  /// Releases a handle. Returns false if this page holds none of that name.
  [[nodiscard]] bool release(live::ClientId client, const std::string& id);

  struct Adapted {
    int frame = 0;  ///< From 0.
    Pose pose;
  };
  /// Returns the page's frame, adapted to all handles that the page holds. Feet in
  /// contact in the recording are supports, unless the file defines supports. nullopt:
  /// the page holds no handle, or 16 other pages have dragged since. Cost: one
  /// Adapter::make() and one adapt(). Errors: those of Adapter::make().
  [[nodiscard]] std::optional<Result<Adapted>> adapted(live::ClientId client) const;

 private:
  struct Held {
    std::string id;
    glm::dvec3 p_in_world{0.0};
  };
  struct Page {
    live::ClientId client{};
    int frame = 0;  ///< From 0.
    std::vector<Held> held;
  };

  ViewHandles() = default;
  [[nodiscard]] bool is_draggable(const std::string& id) const;
  [[nodiscard]] ConstraintSet constraints_of(const Page& page) const;

  std::size_t figure_ = 0;
  Motion motion_;
  Character character_;
  std::vector<BodyHandle> handles_;
  ConstraintSet of_file_;
  /// By foot (left, right) and frame: true if the foot is in contact. Empty: unknown.
  std::array<std::vector<bool>, 2> bears_;
  std::vector<Page> pages_;  ///< In order of their last drag.
};

}  // namespace marey::app
