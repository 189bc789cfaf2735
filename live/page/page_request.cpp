// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_request.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace marey::live {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxBytes = 16 * 1024;
constexpr std::size_t kMaxIdBytes = 200;
constexpr double kMaxDistance_m = 10'000.0;
constexpr int kRequestVersion = 1;

Error refused(std::string cause) {
  return bad_input("message from the page", std::move(cause), "reload the page");
}

/// Reads the members of one message by name and keeps the first error.
class Members {
 public:
  explicit Members(const Json& message) : message_(message) {}

  double number(const char* name) {
    const Json* value = find(name);
    if (value == nullptr) return 0.0;
    const bool is_number = value->is_number() && std::isfinite(value->get<double>());
    return is_number ? value->get<double>() : wrong(name, "a finite number", 0.0);
  }

  bool flag(const char* name) {
    const Json* value = find(name);
    if (value == nullptr) return false;
    return value->is_boolean() ? value->get<bool>() : wrong(name, "true or false", false);
  }

  std::string id(const char* name = "id") {
    std::string text = text_of(name);
    if (cause_.empty() && (text.empty() || text.size() > kMaxIdBytes)) {
      return wrong(name, "1 to 200 bytes long", std::string());
    }
    return text;
  }

  glm::dvec3 place(const char* name) {
    const Json* value = find(name);
    if (value == nullptr) return glm::dvec3(0.0);
    glm::dvec3 p(0.0);
    bool good = value->is_array() && value->size() == 3;
    for (int i = 0; good && i < 3; ++i) {
      const Json& one = (*value)[static_cast<std::size_t>(i)];
      good = one.is_number() && std::abs(one.get<double>()) <= kMaxDistance_m;
      if (good) p[i] = one.get<double>();
    }
    return good ? p : wrong(name, "three numbers within 10 km", glm::dvec3(0.0));
  }

  std::optional<int> frame() {
    if (!message_.contains("frame") || message_["frame"].is_null()) return std::nullopt;
    const Json& value = message_["frame"];
    constexpr std::int64_t kLast = 1 << 30;
    const bool good = value.is_number_integer() && value.get<std::int64_t>() >= 0 &&
                      value.get<std::int64_t>() <= kLast;
    return good ? value.get<int>() : wrong("frame", "the number of a frame", 0);
  }

  int version() {
    const Json* value = find("version");
    if (value == nullptr) return 0;
    return *value == kRequestVersion
               ? kRequestVersion
               : wrong("version", "1: the page is from another marey version", 0);
  }

  /// Returns the value of the member's word in `words`.
  template <class Enum, std::size_t N>
  Enum one_of(const char* name, const std::pair<const char*, Enum> (&words)[N]) {
    const std::string value_text = text_of(name);
    std::string choice;
    for (const auto& [text, value] : words) {
      if (value_text == text) return value;
      choice += (choice.empty() ? "" : ", ") + std::string(text);
    }
    return wrong(name, ("one of " + choice).c_str(), words[0].second);
  }

  std::string text_of(const char* name) {
    const Json* value = find(name);
    if (value == nullptr) return {};
    return value->is_string() ? value->get<std::string>()
                              : wrong(name, "a text", std::string());
  }

  /// Returns the first error; empty: none.
  [[nodiscard]] const std::string& cause() const { return cause_; }

 private:
  const Json* find(const char* name) {
    const auto found = message_.find(name);
    if (found != message_.end()) return &*found;
    if (cause_.empty()) cause_ = std::string(name) + " is missing";
    return nullptr;
  }

  template <class T>
  T wrong(const char* name, const char* want, T instead) {
    if (cause_.empty()) cause_ = std::string(name) + " is not " + want;
    return instead;
  }

  const Json& message_;
  std::string cause_;
};

DragRequest drag(Members& members) {
  DragRequest out;
  out.id = members.id();
  out.p_in_world = members.place("p_in_world");
  out.phase = members.one_of<DragPhase>("phase",
                                        {{"begin", DragPhase::kBegin},
                                         {"move", DragPhase::kMove},
                                         {"end", DragPhase::kEnd}});
  out.frame = members.frame();
  return out;
}

WizardRequest wizard(Members& members) {
  return {members.one_of<WizardAction>("action",
                                       {{"start", WizardAction::kStart},
                                        {"next", WizardAction::kNext},
                                        {"cancel", WizardAction::kCancel},
                                        {"accept", WizardAction::kAccept}})};
}

RunRequest run(Members& members) {
  return {members.one_of<RunAction>("action",
                                    {{"play", RunAction::kPlay},
                                     {"pause", RunAction::kPause},
                                     {"restart", RunAction::kRestart}})};
}

std::optional<PageRequest> of_type(const std::string& type, Members& members) {
  if (type == "hello") return HelloRequest{members.version()};
  if (type == "shown") return ShownRequest{members.number("sent_s")};
  if (type == "drag") return drag(members);
  if (type == "constraint") {
    std::string id = members.id();
    return ConstraintRequest{std::move(id), members.flag("active")};
  }
  if (type == "wizard") return wizard(members);
  if (type == "run") return run(members);
  if (type == "record") return RecordRequest{members.flag("on")};
  if (type == "thumbnails") return ThumbnailsRequest{members.flag("on")};
  if (type == "trial") return TrialRequest{members.id("name")};
  return std::nullopt;
}

}  // namespace

Result<PageRequest> read_page_request(std::string_view text) {
  if (text.size() > kMaxBytes) return refused("it is larger than 16 kB");
  const Json message = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return refused("it is not a JSON object");
  Members members(message);
  const std::string type = members.text_of("type");
  if (!members.cause().empty()) return refused(members.cause());
  std::optional<PageRequest> request = of_type(type, members);
  if (!request) return refused("its type is unknown");
  if (!members.cause().empty()) return refused(members.cause());
  return *std::move(request);
}

}  // namespace marey::live
