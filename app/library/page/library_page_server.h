// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <list>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "library/quality/quality_limits.h"

#include "app/library/find/clip_motions.h"
#include "app/library/page/clip_listing.h"
#include "app/library/page/clip_neighbours.h"
#include "app/library/page/library_messages.h"
#include "app/view/view_page.h"
#include "live/page/library_request.h"
#include "live/web/web_server.h"

namespace marey::app {

/// Answers the messages of the pages of one library. Reads only library.toml,
/// library.sqlite, the search files, failed/, and objects that the index names. Writes
/// only the tables of app/library/page/page_corrections.h. One thread.
class LibraryPageServer {
 public:
  /// Reads the index, and publishes the state of the library. A library without an index,
  /// or with a damaged one, is served with the reason. `server` must outlive this object.
  LibraryPageServer(std::filesystem::path library,
                    std::string query,
                    live::WebServer& server);

  /// Carries out one message. The answer goes to its page.
  void answer(const live::ReceivedText& text);

  /// Reads the index again if its files have changed since, and publishes the new state.
  /// Requests of open pages are outdated then. Cost without a change: two calls of
  /// stat().
  void look();

  [[nodiscard]] const LibraryState& state() const { return state_; }

 private:
  /// Time and size of the index. A build replaces it last.
  struct Stamp {
    std::filesystem::file_time_type index{};
    std::uintmax_t index_bytes = 0;
    bool operator==(const Stamp&) const = default;
  };
  using Answer = Result<std::string>;

  void open();
  [[nodiscard]] Stamp stamp() const;
  [[nodiscard]] Answer carry_out(const LibraryAsker& asker,
                                 const live::LibraryPageRequest& request);
  [[nodiscard]] Answer list(const LibraryAsker& asker,
                            const live::LibraryListRequest& request);
  [[nodiscard]] Answer draw(const LibraryAsker& asker,
                            const live::LibraryPosesRequest& request);
  [[nodiscard]] Answer show(const LibraryAsker& asker,
                            const live::LibraryClipRequest& request);
  [[nodiscard]] Answer store(const LibraryAsker& asker,
                             const live::LibraryVerdictRequest& request);
  [[nodiscard]] Answer store(const LibraryAsker& asker,
                             const live::LibraryLabelRequest& request);
  [[nodiscard]] Result<std::vector<ClipRecord>> records(std::vector<int> numbers) const;
  void add_drawings(const std::vector<int>& numbers);
  void add_neighbours(const live::LibraryClipRequest& request,
                      const LibraryMotion& motion,
                      ShownClip& shown);
  void serve(PageOfRecording page);

  const std::filesystem::path library_;
  live::WebServer& server_;
  LibraryState state_;
  Stamp stamp_;
  std::optional<ClipListing> listing_ = std::nullopt;
  std::optional<ClipNeighbours> neighbours_ = std::nullopt;
  std::string neighbour_trouble_;
  library::QualityLimits limits_{{}};
  ClipMotions motions_;
  std::unordered_map<int, std::string> drawings_;
  std::size_t media_number_ = 0;
  std::list<std::vector<std::string>> served_;  ///< Paths of media, newest last.
};

}  // namespace marey::app
