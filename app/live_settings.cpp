// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_settings.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace marey::app {
namespace {

using nlohmann::json;

Error not_ours(const std::string& file, const std::string& what) {
  return bad_input(file,
                   "it does not say what a live take says: " + what,
                   "copy the take again from where it was recorded");
}

template <class T>
json or_null(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

template <class T>
std::optional<T> optional_at(const json& object, const char* key) {
  const json& value = object.at(key);
  if (value.is_null()) return std::nullopt;
  return value.get<T>();
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
  stream.rest =
      object.at("rest") == "raw" ? live::VmcRest::kRaw : live::VmcRest::kVrm0;
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
  return settings;
}

bool can_be(const LiveSettings& settings) {
  for (const VmcStream& stream : settings.streams) {
    if (stream.avatar && *stream.avatar >= settings.avatars.size()) return false;
  }
  return settings.rate.hz > 0.0 && std::isfinite(settings.rate.hz) &&
         settings.camera_sigma_m >= 0.0 && std::isfinite(settings.camera_sigma_m);
}

LiveRequests to_requests(const json& object) {
  LiveRequests requests;
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

std::string live_settings_text(const LiveSettings& settings) {
  json streams = json::array();
  for (const VmcStream& stream : settings.streams) streams.push_back(to_json(stream));
  const json object{{"rate_hz", settings.rate.hz},
                    {"camera_sigma_m", settings.camera_sigma_m},
                    {"lag_known", settings.lag_known},
                    {"avatars", settings.avatars},
                    {"vmc", std::move(streams)},
                    {"vrchat", settings.vrchat}};
  return object.dump();
}

Result<LiveSettings> parse_live_settings(std::string_view text, const std::string& file) {
  // nlohmann-json throws; nothing else here does.
  try {
    LiveSettings settings = to_settings(json::parse(text));
    if (!can_be(settings)) return not_ours(file, "a value is out of range");
    return settings;
  } catch (const json::exception& problem) {
    return not_ours(file, problem.what());
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
  return asked ? json{{"vmc", std::move(streams)}}.dump() : std::string{};
}

Result<LiveRequests> parse_live_requests(std::string_view text, const std::string& file) {
  if (text.empty()) return LiveRequests{};
  try {
    return to_requests(json::parse(text));
  } catch (const json::exception& problem) {
    return not_ours(file, problem.what());
  }
}

}  // namespace marey::app
