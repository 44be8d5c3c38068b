#ifndef SF_APP_CAPTURE_H
#define SF_APP_CAPTURE_H

#include "options.h"

enum sf_status sf_capture_run(const struct sf_arguments *arguments);

#endif
