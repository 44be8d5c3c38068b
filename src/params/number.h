/* Numbers as text, always with a decimal point whatever the host's locale says. */
#ifndef SF_PARAMS_NUMBER_H
#define SF_PARAMS_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

/* Reads the whole of text[0..length): sign, digits with at most one point, exponent. False for anything else (spaces,
 * hexadecimal, nan, inf) and for numbers that do not fit a double. Correctly rounded. */
bool sf_number_parse(const char *text, size_t length, double *value);

enum { SF_NUMBER_BYTES = 32 };
/* The shortest decimal that parses to the same float. The value must be finite. */
void sf_number_print(float value, char buffer[SF_NUMBER_BYTES]);
/* The shortest of 15 to 17 digits that parses to the same double, its sign included when it is 0. Finite. */
void sf_number_print_double(double value, char buffer[SF_NUMBER_BYTES]);
/* Seven significant digits, for messages and documents; any value. */
void sf_number_show(double value, char buffer[SF_NUMBER_BYTES]);

#endif
