// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace marey::app {
namespace {

using nlohmann::json;

Error not_ours(const std::string& file, const std::string& what) {
  return bad_input(file,
                   "it is not in the format of a live take: " + what,
                   "copy the take again from where it was recorded");
}

/// Returns JSON text. Bytes of names that are not UTF-8 are replaced.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

template <class T>
json or_null(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

/// Throws the exception of nlohmann::json if the value is not a count.
template <class T>
std::optional<T> optional_at(const json& object, const char* key) {
  constexpr json::number_unsigned_t kMax = 1'000'000;
  const json& value = object.at(key);
  if (value.is_null()) return std::nullopt;
  const auto& count = value.get_ref<const json::number_unsigned_t&>();
  return static_cast<T>(std::min(count, kMax));
}

json to_json(const VmcStream& stream) {
  return {{"avatar", or_null(stream.avatar)},
          {"rest", stream.rest == live::VmcRest::kRaw ? "raw" : "vrm0"},
          {"mtu_bytes", or_null(stream.mtu_bytes)},
          {"listen_port", or_null(stream.listen_port)}};
}

VmcStream to_stream(const json& object) {
  VmcStream stream;
  stream.avatar = optional_at<std::size_t>(object, "avatar");
  stream.rest = object.at("rest") == "raw" ? live::VmcRest::kRaw : live::VmcRest::kVrm0;
  stream.mtu_bytes = optional_at<int>(object, "mtu_bytes");
  stream.listen_port = optional_at<int>(object, "listen_port");
  return stream;
}

LiveSettings to_settings(const json& object) {
  LiveSettings settings;
  settings.rate.hz = object.at("rate_hz").get<double>();
  settings.camera_sigma_m = object.at("camera_sigma_m").get<double>();
  settings.lag_known = object.at("lag_known").get<std::vector<bool>>();
  settings.avatars = object.at("avatars").get<std::vector<std::string>>();
  for (const json& stream : object.at("vmc")) {
    settings.streams.push_back(to_stream(stream));
  }
  settings.vrchat = object.at("vrchat").get<bool>();
  if (const auto files = object.find("avatar_files"); files != object.end()) {
    settings.avatar_files = files->get<std::vector<std::string>>();
  }
  settings.balance_preview = object.contains("balance");
  // Only takes that start during a run have it.
  if (const auto begin = object.find("vmc_begin_ns"); begin != object.end()) {
    settings.vmc_begin = Timestamp{begin->get<std::int64_t>()};
  }
  return settings;
}

/// Returns false for a balance that this version does not know. Takes without a preview
/// have no value.
bool is_balance_known(const json& object) {
  const auto balance = object.find("balance");
  return balance == object.end() || *balance == "preview";
}

bool can_be(const LiveSettings& settings) {
  if (!settings.avatar_files.empty() &&
      settings.avatar_files.size() != settings.avatars.size()) {
    return false;
  }
  for (const VmcStream& stream : settings.streams) {
    if (stream.avatar && *stream.avatar >= settings.avatars.size()) return false;
  }
  // Limits for any camera and any rig.
  constexpr double kMinRate_hz = 0.1;
  constexpr double kMaxRate_hz = 1e4;
  constexpr double kMaxSigma_m = 10.0;
  return settings.rate.hz >= kMinRate_hz && settings.rate.hz <= kMaxRate_hz &&
         settings.camera_sigma_m >= 0.0 && settings.camera_sigma_m <= kMaxSigma_m;
}

constexpr std::array<std::pair<HandleAction, const char*>, 3> kActions{
    {{HandleAction::kMove, "move"},
     {HandleAction::kStart, "start"},
     {HandleAction::kStop, "stop"}}};

json to_json(const HandleRequest& request) {
  json object{{"id", request.id}};
  for (const auto& [action, word] : kActions) {
    if (action == request.action) object["action"] = word;
  }
  if (request.action == HandleAction::kMove) {
    const glm::dvec3& p = request.p_in_world;
    object["p_in_world"] = {p.x, p.y, p.z};
  }
  return object;
}

/// Returns nullopt if a value is invalid.
std::optional<HandleRequest> to_handle(const json& object) {
  constexpr double kMaxDistance_m = 1e4;
  HandleRequest request;
  request.id = object.at("id").get<std::string>();
  const auto word = object.at("action").get<std::string>();
  const auto* action = std::ranges::find(
      kActions, word, [](const auto& known) { return std::string_view(known.second); });
  if (action == kActions.end()) return std::nullopt;
  request.action = action->first;
  if (request.action != HandleAction::kMove) return request;
  const json& place = object.at("p_in_world");
  if (!place.is_array() || place.size() != 3) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    const auto x = place[static_cast<std::size_t>(i)].get<double>();
    if (!(std::abs(x) <= kMaxDistance_m)) return std::nullopt;
    request.p_in_world[i] = x;
  }
  return request;
}

/// Returns nullopt if a value is out of range.
std::optional<LiveRequests> to_requests(const json& object) {
  LiveRequests requests;
  // Takes of earlier versions have neither this nor handles.
  requests.behind = object.value("behind", false);
  if (const auto handles = object.find("handles"); handles != object.end()) {
    if (handles->size() > LiveRequests::kMaxHandles) return std::nullopt;
    for (const json& asked : *handles) {
      auto request = to_handle(asked);
      if (!request) return std::nullopt;
      requests.handles.push_back(*std::move(request));
    }
  }
  for (const json& asked : object.at("vmc")) {
    LiveRequests::OfStream& one = requests.streams.emplace_back();
    one.info = asked.at("info").get<bool>();
    if (const json& periods = asked.at("periods"); !periods.is_null()) {
      one.periods = live::VmcPeriods{periods.at("status").get<int>(),
                                     periods.at("root").get<int>(),
                                     periods.at("bone").get<int>()};
    }
  }
  return requests;
}

}  // namespace

std::string shown_name(const std::filesystem::path& file) {
  // The JSON writer replaces invalid UTF-8.
  return json::parse(text_of(file.filename().string())).get<std::string>();
}

std::string live_settings_text(const LiveSettings& settings) {
  json streams = json::array();
  for (const VmcStream& stream : settings.streams) streams.push_back(to_json(stream));
  json object{{"rate_hz", settings.rate.hz},
              {"camera_sigma_m", settings.camera_sigma_m},
              {"lag_known", settings.lag_known},
              {"avatars", settings.avatars},
              {"vmc", std::move(streams)},
              {"vrchat", settings.vrchat}};
  if (settings.vmc_begin) object["vmc_begin_ns"] = settings.vmc_begin->count();
  if (!settings.avatar_files.empty()) object["avatar_files"] = settings.avatar_files;
  if (settings.balance_preview) object["balance"] = "preview";
  return text_of(object);
}

Result<LiveSettings> parse_live_settings(std::string_view text, const std::string& file) {
  // Only nlohmann-json throws here.
  try {
    const json object = json::parse(text);
    LiveSettings settings = to_settings(object);
    if (!can_be(settings) || !is_balance_known(object))
      return not_ours(file, "a value is out of range");
    return settings;
  } catch (const json::exception& problem) {
    return not_ours(file, problem.what());
  }
}

bool LiveRequests::add(HandleRequest request) {
  // Only the last of several moves between two instants is kept.
  const bool is_void = !handles.empty() && request.action == HandleAction::kMove &&
                       handles.back().action == HandleAction::kMove &&
                       handles.back().id == request.id;
  if (is_void) {
    handles.back() = std::move(request);
    return true;
  }
  if (handles.size() >= kMaxHandles) return false;
  handles.push_back(std::move(request));
  return true;
}

void KeptPeriods::apply(const LiveRequests& requests) {
  if (periods_.size() < requests.streams.size()) periods_.resize(requests.streams.size());
  for (std::size_t s = 0; s < requests.streams.size(); ++s) {
    if (requests.streams[s].periods) periods_[s] = requests.streams[s].periods;
  }
}

void KeptPeriods::add_to(LiveRequests& requests) const {
  if (requests.streams.size() < periods_.size()) requests.streams.resize(periods_.size());
  for (std::size_t s = 0; s < periods_.size(); ++s) {
    auto& periods = requests.streams[s].periods;
    if (!periods) periods = periods_[s];
  }
}

std::string live_requests_text(const LiveRequests& requests) {
  bool asked = false;
  json streams = json::array();
  for (const LiveRequests::OfStream& one : requests.streams) {
    asked = asked || one.info || one.periods;
    json periods(nullptr);
    if (one.periods) {
      periods = {{"status", one.periods->status},
                 {"root", one.periods->root},
                 {"bone", one.periods->bone}};
    }
    streams.push_back({{"info", one.info}, {"periods", std::move(periods)}});
  }
  if (!asked && requests.handles.empty() && !requests.behind) return {};
  json object{{"vmc", std::move(streams)}};
  if (requests.behind) object["behind"] = true;
  for (const HandleRequest& request : requests.handles) {
    object["handles"].push_back(to_json(request));
  }
  return text_of(object);
}

Result<LiveRequests> parse_live_requests(std::string_view text, const std::string& file) {
  if (text.empty()) return LiveRequests{};
  try {
    auto requests = to_requests(json::parse(text));
    if (!requests) return not_ours(file, "a value is out of range");
    return *std::move(requests);
  } catch (const json::exception& problem) {
    return not_ours(file, problem.what());
  }
}

}  // namespace marey::app
