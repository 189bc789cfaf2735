// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace marey::live {

/// One thing that can be fetched. The server knows what it was given and no files: no
/// path leads anywhere else.
struct WebContent {
  std::string path;          ///< "/page.js", "/media/3"; "/" is the page itself.
  std::string content_type;  ///< "text/javascript; charset=utf-8".
  /// Shared with answers that are still under way when it is replaced; immutable.
  std::shared_ptr<const std::string> bytes;
  /// The bytes are gzip's, and say so to the browser.
  bool gzipped = false;
  /// Quoted, as in the header: "\"5f2c\"". Browsers ask for it again and are told that
  /// they have it. Empty: not to be kept at all, as what belongs to one run.
  std::string etag;
  /// What its page may do instead of what ours may (Content-Security-Policy); empty: as
  /// ours.
  std::string policy{};
};

/// Whether content may have this path: "/", letters, digits and "._-/", no "..", at most
/// 200 characters.
[[nodiscard]] bool is_web_path(std::string_view path);

}  // namespace marey::live
