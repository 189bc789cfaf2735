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

/// A stream of VMC packets: its body and its encoding.
struct VmcStream {
  /// Position in the list of avatars; nullopt: the performer's own skeleton.
  std::optional<std::size_t> avatar;
  live::VmcRest rest = live::VmcRest::kVrm0;
  std::optional<int> mtu_bytes;  ///< As in VmcEncoderOptions.
  std::optional<int> listen_port;
};

/// Settings that determine the results of a live run, in addition to the files of
/// cameras, subject and avatars. A replay needs the same values.
struct LiveSettings {
  FrameRate rate;
  double camera_sigma_m = 0.0;
  /// By camera: its timestamps are the exposure times, without an unknown lag.
  std::vector<bool> lag_known;
  std::vector<std::string> avatars;  ///< File names, see shown_name().
  /// File names in the take; empty: `avatars`, as in takes of earlier versions.
  std::vector<std::string> avatar_files{};
  std::vector<VmcStream> streams;
  /// Time 0 of the VMC message T; nullopt: the first instant.
  std::optional<Timestamp> vmc_begin{};
  bool vrchat = false;  ///< Packets of the performer's trackers follow the streams'.
  /// Poses are delayed by 0.8 s and balanced (app/live_chain/live_preview.h).
  bool balance_preview = false;
};

/// Returns the name of a file as valid UTF-8: invalid bytes are replaced by U+FFFD.
[[nodiscard]] std::string shown_name(const std::filesystem::path& file);

/// Returns the settings as JSON, in one line.
[[nodiscard]] std::string live_settings_text(const LiveSettings& settings);

/// Parses the text of live_settings_text(). Errors (kBadInput), at `file`: another
/// format; a stream of an unknown avatar.
[[nodiscard]] Result<LiveSettings> parse_live_settings(std::string_view text,
                                                       const std::string& file);

/// User action on a handle of the first avatar (app/live_chain/live_handles.h).
enum class HandleAction {
  kMove,   ///< Moves it to a position; starts it if it is inactive.
  kStart,  ///< Holds its joint at its current position.
  kStop,   ///< Releases the joint to the motion.
};
struct HandleRequest {
  std::string id;  ///< "left hand".
  HandleAction action = HandleAction::kMove;
  glm::dvec3 p_in_world{0.0};  ///< Target of kMove, in the avatar's world.
};

/// Requests received since the previous instant that affect the results.
struct LiveRequests {
  static constexpr std::size_t kMaxHandles = 64;  ///< Requests for handles.

  /// Requests of one stream: the VMC commands Set/Period and Set/Req.
  struct OfStream {
    std::optional<live::VmcPeriods> periods;
    bool info = false;
  };
  std::vector<OfStream> streams;  ///< Empty: no requests.
  std::vector<HandleRequest> handles{};
  /// Poses do not keep up with the cameras (LiveFlow); packets report "not tracked".
  bool behind = false;

  void clear() {
    streams.clear();
    handles.clear();
    behind = false;
  }
  /// Adds a request and replaces an earlier one that it makes obsolete. Returns false if
  /// there are already too many.
  bool add(HandleRequest request);
};

/// Keeps the latest requested periods of each stream, to pass them to a later chain.
class KeptPeriods {
 public:
  void apply(const LiveRequests& requests);
  /// Adds them to the requests of streams without other periods.
  void add_to(LiveRequests& requests) const;

 private:
  std::vector<std::optional<live::VmcPeriods>> periods_;  ///< By stream.
};

/// Returns the requests as JSON in one line; empty if there are none.
[[nodiscard]] std::string live_requests_text(const LiveRequests& requests);

/// Parses the text of live_requests_text(). Errors (kBadInput), at `file`: another
/// format.
[[nodiscard]] Result<LiveRequests> parse_live_requests(std::string_view text,
                                                       const std::string& file);

}  // namespace marey::app
