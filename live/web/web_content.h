// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace marey::live {

/// One resource that can be fetched. The server serves only these resources; a path never
/// refers to a file.
struct WebContent {
  std::string path;          ///< "/page.js", "/media/3"; "/" is the page itself.
  std::string content_type;  ///< "text/javascript; charset=utf-8".
  /// Immutable; shared with responses that are still being sent when it is replaced.
  std::shared_ptr<const std::string> bytes;
  /// The bytes are compressed with gzip (Content-Encoding).
  bool gzipped = false;
  /// Quoted, as in the header: "\"5f2c\"". Browsers revalidate with it and get 304.
  /// Empty: not cached at all, for content of one run.
  std::string etag;
  /// Content-Security-Policy of this resource; empty: that of marey's page.
  std::string policy{};
};

/// Returns true if content may have this path: it begins with "/", has letters, digits
/// and "._-/", no "..", and at most 200 characters.
[[nodiscard]] bool is_web_path(std::string_view path);

}  // namespace marey::live
