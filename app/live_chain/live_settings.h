// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/base/time.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_encoder.h"

namespace marey::app {

/// A stream of VMC packets: who is shown, and how.
struct VmcStream {
  /// Position in the list of avatars; nullopt: the performer's own skeleton.
  std::optional<std::size_t> avatar;
  live::VmcRest rest = live::VmcRest::kVrm0;
  std::optional<int> mtu_bytes;  ///< As in VmcEncoderOptions.
  std::optional<int> listen_port;
};

/// All that the results of a live run depend on beside cameras, subject and avatars'
/// files: what a replay has to have again.
struct LiveSettings {
  FrameRate rate;
  double camera_sigma_m = 0.0;
  /// Per camera: its stamps are the instants of its pictures, without a lag of their own.
  std::vector<bool> lag_known;
  std::vector<std::string> avatars;  ///< By the names of their files: shown_name().
  /// Names of their files in the take; empty: `avatars`, as in takes of earlier versions.
  std::vector<std::string> avatar_files{};
  std::vector<VmcStream> streams;
  /// Since when VMC's T counts; nullopt: since the first instant.
  std::optional<Timestamp> vmc_begin{};
  bool vrchat = false;  ///< Packets of the performer's trackers, after those of streams.
};

/// The name of a file as it is told to others, whatever bytes it has: what is not UTF-8 is
/// replaced by U+FFFD.
[[nodiscard]] std::string shown_name(const std::filesystem::path& file);

/// As JSON, in one line.
[[nodiscard]] std::string live_settings_text(const LiveSettings& settings);

/// Errors (kBadInput), at `file`: not such a text; streams of avatars that there are not.
[[nodiscard]] Result<LiveSettings> parse_live_settings(std::string_view text,
                                                       const std::string& file);

/// What a person does with a handle of the first avatar (app/live_chain/live_handles.h).
enum class HandleAction {
  kMove,   ///< To a place; it is taken hold of if nobody has.
  kStart,  ///< It holds its joint where that is.
  kStop,   ///< The joint goes its own way again.
};
struct HandleRequest {
  std::string id;  ///< "left hand".
  HandleAction action = HandleAction::kMove;
  glm::dvec3 p_in_world{0.0};  ///< Of kMove, in the avatar's world.
};

/// What others asked for since the instant before, and results depend on.
struct LiveRequests {
  static constexpr std::size_t kMaxHandles = 64;  ///< Requests about handles.

  /// By stream: what Set/Period and Set/Req asked.
  struct OfStream {
    std::optional<live::VmcPeriods> periods;
    bool info = false;
  };
  std::vector<OfStream> streams;  ///< Empty: nobody asked for anything.
  std::vector<HandleRequest> handles{};
  /// Poses do not keep up with the cameras (LiveFlow): receivers must not trust them.
  bool behind = false;

  void clear() {
    streams.clear();
    handles.clear();
    behind = false;
  }
  /// Adds a request, in place of one before it that it makes void. False: there are too
  /// many already.
  bool add(HandleRequest request);
};

/// The periods that were asked for last, which count until others are asked for: told to a
/// chain that comes later.
class KeptPeriods {
 public:
  void apply(const LiveRequests& requests);
  /// Adds them to what is asked for, where that says nothing else.
  void add_to(LiveRequests& requests) const;

 private:
  std::vector<std::optional<live::VmcPeriods>> periods_;  ///< By stream.
};

/// As JSON in one line; empty when nothing was asked for.
[[nodiscard]] std::string live_requests_text(const LiveRequests& requests);

/// Errors (kBadInput), at `file`: not such a text.
[[nodiscard]] Result<LiveRequests> parse_live_requests(std::string_view text,
                                                       const std::string& file);

}  // namespace marey::app
