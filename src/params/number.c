#include "params/number.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A decimal is longer than this only when somebody means harm. */
enum { LONGEST = 512 };

static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* What strtod reads between the digits. */
static const char *decimal_point(void)
{
    const struct lconv *conventions = localeconv();

    return conventions && conventions->decimal_point && *conventions->decimal_point ? conventions->decimal_point : ".";
}

static bool parse_slowly(const char *text, size_t length, double *value)
{
    char buffer[LONGEST + 16], *end;
    const char *point = memchr(text, '.', length), *mark = decimal_point();
    size_t head = point ? (size_t)(point - text) : length, width = point ? strlen(mark) : 0;

    if (length > LONGEST || width > 8)
        return false;
    memcpy(buffer, text, head);
    if (point) {
        memcpy(buffer + head, mark, width);
        memcpy(buffer + head + width, point + 1, length - head - 1);
        length += width - 1;
    }
    buffer[length] = '\0';
    *value = strtod(buffer, &end);
    return end == buffer + length && isfinite(*value);
}

bool sf_number_parse(const char *text, size_t length, double *value)
{
    const char *at = text, *end = text + length;
    bool negative = false, exact = true;
    uint64_t mantissa = 0;
    int digits = 0, scale = 0, exponent = 0;

    if (at < end && (*at == '-' || *at == '+'))
        negative = *at++ == '-';
    for (bool point = false; at < end; at++) {
        if (*at == '.' && !point) {
            point = true;
            continue;
        }
        if (*at < '0' || *at > '9')
            break;
        digits++;
        if (mantissa < (UINT64_MAX - 9) / 10)
            mantissa = mantissa * 10 + (uint64_t)(*at - '0');
        else
            exact = false;
        scale -= point;
    }
    if (digits == 0)
        return false;
    if (at < end && (*at == 'e' || *at == 'E')) {
        bool down = false;
        const char *first;

        if (++at < end && (*at == '-' || *at == '+'))
            down = *at++ == '-';
        for (first = at; at < end && *at >= '0' && *at <= '9'; at++)
            if (exponent < 100000)
                exponent = exponent * 10 + (*at - '0');
        if (at == first)
            return false;
        exponent = down ? -exponent : exponent;
    }
    if (at != end)
        return false;
    /* Both factors are exact doubles, so one operation rounds once (Clinger, "How to read floating point numbers
     * accurately"). */
    exponent += scale;
    if (exact && mantissa <= (UINT64_C(1) << 53) && exponent >= -22 && exponent <= 22) {
        double magnitude = exponent < 0 ? (double)mantissa / powers[-exponent] : (double)mantissa * powers[exponent];

        *value = negative ? -magnitude : magnitude;
        return true;
    }
    return parse_slowly(text, length, value);
}

static void print(double value, int precision, char buffer[SF_NUMBER_BYTES])
{
    const char *mark = decimal_point();
    char *found;

    snprintf(buffer, SF_NUMBER_BYTES, "%.*g", precision, value);
    if (strcmp(mark, ".") != 0 && (found = strstr(buffer, mark))) {
        *found = '.';
        memmove(found + 1, found + strlen(mark), strlen(found + strlen(mark)) + 1);
    }
}

void sf_number_print(float value, char buffer[SF_NUMBER_BYTES])
{
    for (int precision = 6; precision <= FLT_DECIMAL_DIG; precision++) {
        double read;

        print(value, precision, buffer);
        if (sf_number_parse(buffer, strlen(buffer), &read) && (float)read == value)
            return;
    }
}

void sf_number_print_double(double value, char buffer[SF_NUMBER_BYTES])
{
    double read = 0;

    for (int precision = DBL_DIG; precision <= DBL_DECIMAL_DIG; precision++) {
        print(value, precision, buffer);
        if (sf_number_parse(buffer, strlen(buffer), &read) && read == value)
            return;
    }
}

void sf_number_show(double value, char buffer[SF_NUMBER_BYTES])
{
    print(value, 7, buffer);
}
