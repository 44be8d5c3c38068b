#ifndef SF_APP_TEXTURE_H
#define SF_APP_TEXTURE_H

#include "options.h"

enum { SF_TEXTURE_OUTPUTS_MAX = 8 };

enum sf_status sf_texture_run(const struct sf_arguments *arguments);

#endif
