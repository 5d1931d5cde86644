#pragma once

namespace ehdjet {

/// While it lives, errors of the GNU Scientific Library come back as status codes. GSL's own handler
/// ends the process, and a handler of the calling program is none of our business: afterwards
/// the handler is the one of before. May be nested, and used in several threads.
class GslErrors {
public:
  GslErrors();
  ~GslErrors();
  GslErrors(const GslErrors&) = delete;
  GslErrors& operator=(const GslErrors&) = delete;

  /// errors : RunError with `what` and GSL's own words unless `status` is success
  static void check(int status, const char* what);
};

} // namespace ehdjet
