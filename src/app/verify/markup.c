#include "markup.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes of the UTF-8 character that begins there; 0 when none does, or one that XML does not have. */
static size_t character(const unsigned char *at)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    size_t length = at[0] < 0x80 ? 1 : at[0] >> 5 == 6 ? 2 : at[0] >> 4 == 14 ? 3 : at[0] >> 3 == 30 ? 4 : 0;
    uint32_t code = length > 1 ? at[0] & (0x7fu >> length) : at[0];

    for (size_t i = 1; i < length; i++) {
        if (at[i] >> 6 != 2)
            return 0;
        code = code << 6 | (at[i] & 0x3fu);
    }
    bool allowed = length > 0 && code >= least[length] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff) &&
                   code != 0xfffe && code != 0xffff;
    return allowed ? length : 0;
}

void sf_markup_text(FILE *stream, const char *text)
{
    for (const unsigned char *at = (const unsigned char *)text; *at;) {
        size_t length = character(at);

        if (length == 0)
            fputc('?', stream);
        else if (*at == '<')
            fputs("&lt;", stream);
        else if (*at == '>')
            fputs("&gt;", stream);
        else if (*at == '&')
            fputs("&amp;", stream);
        else if (*at == '"')
            fputs("&quot;", stream);
        else if (*at < 0x20 || *at == 0x7f)
            fputc(' ', stream);
        else
            fwrite(at, 1, length, stream);
        at += length > 0 ? length : 1;
    }
}
