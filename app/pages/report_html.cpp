// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <nlohmann/json.hpp>

#include "app/pages/base64.h"
#include "app/pages/fill_page.h"
#include "app/pages/report_body.h"
#include "app/pages/report_json.h"
#include "app/pages/report_page.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

Json page_tag(const ReportTag& tag) {
  std::string counts;
  for (const int count : tag.cameras_seeing) {
    counts += static_cast<char>(std::clamp(count, 0, 255));
  }
  return {{"id", tag.id}, {"segment", tag.segment}, {"cameras", base64(counts)}};
}

Json page_picture(const ReportPicture& picture) {
  const auto px = [](double value_px) { return rounded(value_px, 1); };
  Json bones = Json::array();
  for (const ReportPicture::Bone& bone : picture.bones) {
    bones.push_back({px(bone.from_px.x),
                     px(bone.from_px.y),
                     px(bone.to_px.x),
                     px(bone.to_px.y),
                     static_cast<int>(bone.source)});
  }
  Json tags = Json::array();
  for (const ReportPicture::Tag& tag : picture.tags) {
    Json corners = Json::array();
    for (const glm::dvec2& corner : tag.corners_px) {
      corners.push_back({px(corner.x), px(corner.y)});
    }
    tags.push_back({{"id", tag.id}, {"corners", corners}});
  }
  return {{"camera", picture.camera},
          {"frame", picture.frame},
          {"width_px", picture.width_px},
          {"height_px", picture.height_px},
          {"jpeg", base64(picture.jpeg)},
          {"bones", bones},
          {"tags", tags}};
}

Json page_trial(const ReportTrial& trial) {
  Json rms = Json::array();
  for (const double value_px : trial.frame_rms_px) rms.push_back(rounded(value_px, 3));
  Json tags = Json::array();
  for (const ReportTag& tag : trial.tags) tags.push_back(page_tag(tag));
  Json pictures = Json::array();
  for (const ReportPicture& picture : trial.pictures) {
    pictures.push_back(page_picture(picture));
  }
  Json bodies = Json::array();
  for (const ReportBody& body : trial.bodies) bodies.push_back(page_body(body));
  return {
      {"frame_rms_px", rms}, {"tags", tags}, {"pictures", pictures}, {"bodies", bodies}};
}

}  // namespace

std::string report_html(const Report& report) {
  Json trials = Json::array();
  for (const ReportTrial& trial : report.trials) trials.push_back(page_trial(trial));
  const Json data{{"figures", report_json(report)},
                  {"trials", trials},
                  {"calibration_page", report.has_calibration_page}};
  return fill_page(report_page(),
                   {{"style", std::string(report_style())},
                    {"data", json_in_html(data)},
                    {"script", std::string(report_script())}});
}

}  // namespace marey::app
