/* The table of parameters as people and editors read it. All three append to `text` (check text->failed) and depend on
 * nothing but the rows. */
#ifndef SF_PARAMS_DOCUMENT_H
#define SF_PARAMS_DOCUMENT_H

#include "params/params.h"

/* One line a parameter: name as --set takes it, default, range, meaning. */
void sf_param_document_text(const struct sf_param_group *root, struct sf_text *text);
/* docs/params.md. */
void sf_param_document_markdown(const struct sf_param_group *root, struct sf_text *text);
/* JSON Schema (draft 2020-12) of scene files. */
void sf_param_document_schema(const struct sf_param_group *root, struct sf_text *text);

#endif
