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

/// The first human figure of a recording, whose frames people look at with a hand, a foot,
/// the head or the hips elsewhere: handles that are dragged, and the constraints of a
/// file, which hold as it says. The recording itself stays as it is.
class ViewHandles {
 public:
  /// `constraints` is a file of constraints, or empty. Without a human figure there are no
  /// handles. Errors: reading the file; with constraints those of check_constraints(), and
  /// that there is nobody to have them.
  [[nodiscard]] static Result<ViewHandles> make(const ViewedRecording& recording,
                                                const std::filesystem::path& constraints);

  /// As the scene has them: the file's, then the handles of the body.
  [[nodiscard]] std::vector<live::PageConstraint> constraints() const;
  /// Which of the recording's figures it is.
  [[nodiscard]] std::size_t figure() const { return figure_; }

  /// Notes what a page drags. What it dragged before in the same frame is kept there; in
  /// another frame all of it is forgotten. Of the last 16 pages.
  /// Errors (kBadInput), for the page: no such handle, or frame, or none said.
  [[nodiscard]] Status drag(live::ClientId client, const live::DragRequest& drag);
  /// A handle is not held any more. False: this page held none of that name.
  [[nodiscard]] bool release(live::ClientId client, const std::string& id);

  struct Adapted {
    int frame = 0;  ///< From 0.
    Pose pose;
  };
  /// The frame that the page drags in, brought to all that it holds; feet that bear in
  /// the recording stand, unless the file has supports. Costs an Adapter::make() and an
  /// adapt(). nullopt: the page drags nothing, or 16 others have dragged since.
  /// Errors: Adapter::make()'s.
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
  /// Left, right: whether the foot bears, by frame. Empty: nobody knows.
  std::array<std::vector<bool>, 2> bears_;
  std::vector<Page> pages_;  ///< The one that dragged last is the last.
};

}  // namespace marey::app
