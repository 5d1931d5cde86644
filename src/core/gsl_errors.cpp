#include "ehdjet/core/gsl_errors.hpp"

#include "ehdjet/core/error.hpp"

#include <gsl/gsl_errno.h>

#include <mutex>
#include <string>

namespace ehdjet {
namespace {

std::mutex guard;
int users = 0;
gsl_error_handler_t* handler_before = nullptr;

} // namespace

GslErrors::GslErrors() {
  const std::scoped_lock lock(guard);
  if (users++ == 0) handler_before = gsl_set_error_handler_off();
}

GslErrors::~GslErrors() {
  const std::scoped_lock lock(guard);
  if (--users == 0) gsl_set_error_handler(handler_before);
}

void GslErrors::check(int status, const char* what) {
  if (status != GSL_SUCCESS)
    throw RunError(std::string(what) + " (" + gsl_strerror(status) + ")");
}

} // namespace ehdjet
