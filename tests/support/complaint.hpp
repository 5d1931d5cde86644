#pragma once

#include "ehdjet/core/error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ehdjet {

/// What `action` complains about; "(accepted)" if it does not.
template <class Action>
std::string complaint(Action action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  return "(accepted)";
}

inline void expect_all(const std::string& message, const std::vector<std::string>& parts) {
  for (const auto& part : parts)
    EXPECT_NE(message.find(part), std::string::npos)
        << "no `" << part << "` in:\n  " << message;
}

} // namespace ehdjet
