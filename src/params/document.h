/* The table of parameters as people and editors read it. All append to `text` (check text->failed) and depend on
 * nothing but the rows. */
#ifndef SF_PARAMS_DOCUMENT_H
#define SF_PARAMS_DOCUMENT_H

#include "params/params.h"

/* What is documented: the rows of one kind of file. */
struct sf_param_document {
    const struct sf_param_group *root;
    const char *const *intro;    /* lines of the Markdown document before its tables, NULL-terminated */
    const char *title, *made_by; /* of the schema; the command that makes it */
    /* A group that another document describes: what stands in the place of its table. Ended by a NULL group. */
    const struct {
        const struct sf_param_group *group;
        const char *text;
    } elsewhere[4];
};

/* One line a parameter: name as --set takes it, default, range, meaning. */
void sf_param_document_text(const struct sf_param_document *document, struct sf_text *text);
/* docs/params.md, docs/effect-params.md. */
void sf_param_document_markdown(const struct sf_param_document *document, struct sf_text *text);
/* JSON Schema (draft 2020-12) of the files. */
void sf_param_document_schema(const struct sf_param_document *document, struct sf_text *text);

#endif
