/* Text into XML and HTML. */
#ifndef SF_APP_VERIFY_MARKUP_H
#define SF_APP_VERIFY_MARKUP_H

#include <stdio.h>

/* The text with < > & " as entities; control characters become blanks, bytes that are not UTF-8 question marks. */
void sf_markup_text(FILE *stream, const char *text);

#endif
