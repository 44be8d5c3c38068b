/* The plots of error against time. */
#ifndef SF_APP_VERIFY_PLOTS_H
#define SF_APP_VERIFY_PLOTS_H

#include "verify.h"

/* Of one case, or of the means over all. SVG, malloc'ed; NULL when memory is out. */
char *sf_verify_plot_case(const struct sf_verify *verify, const struct sf_verify_case *result);
char *sf_verify_plot_all(const struct sf_verify *verify);

#endif
