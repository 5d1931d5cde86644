#pragma once

#include <string>

namespace ehdjet {

/// A text as it stands in XML.
inline std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

} // namespace ehdjet
