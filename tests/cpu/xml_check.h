/* Is a text well-formed XML? Elements closed in order, attributes quoted and given once, entities known. */
#ifndef SF_TESTS_XML_CHECK_H
#define SF_TESTS_XML_CHECK_H

#include "scratch.h"
#include <ctype.h>
#include <stdbool.h>

struct xml {
    const char *text, *at;
    char open[64][32]; /* elements that are not closed yet */
    int depth;
    size_t elements;
};

static inline void xml_fail(const struct xml *xml, const char *what)
{
    fail_msg("at byte %ld: %s: %.60s", (long)(xml->at - xml->text), what, xml->at);
}

/* &lt; &gt; &amp; &quot; or &#NNN; */
static inline void xml_entity(struct xml *xml)
{
    static const char *const known[] = {"&lt;", "&gt;", "&amp;", "&quot;"};

    for (size_t i = 0; i < 4; i++)
        if (strncmp(xml->at, known[i], strlen(known[i])) == 0) {
            xml->at += strlen(known[i]);
            return;
        }
    if (xml->at[1] != '#' || !isdigit((unsigned char)xml->at[2]))
        xml_fail(xml, "unknown entity");
    for (xml->at += 2; isdigit((unsigned char)*xml->at); xml->at++)
        ;
    if (*xml->at++ != ';')
        xml_fail(xml, "entity without end");
}

static inline void xml_name(struct xml *xml, char name[32])
{
    size_t length = 0;

    while (isalnum((unsigned char)*xml->at) || strchr("-_:", *xml->at)) {
        if (!*xml->at || length >= 31)
            xml_fail(xml, "a name ends badly");
        name[length++] = *xml->at++;
    }
    name[length] = '\0';
    if (length == 0 || isdigit((unsigned char)name[0]))
        xml_fail(xml, "no name");
}

static inline void xml_attributes(struct xml *xml)
{
    char seen[16][32];

    for (int count = 0; isspace((unsigned char)*xml->at); count++) {
        while (isspace((unsigned char)*xml->at))
            xml->at++;
        if (*xml->at == '>' || *xml->at == '/')
            return;
        if (count >= 16)
            xml_fail(xml, "too many attributes");
        xml_name(xml, seen[count]);
        for (int i = 0; i < count; i++)
            if (strcmp(seen[i], seen[count]) == 0)
                xml_fail(xml, "an attribute twice");
        if (strncmp(xml->at, "=\"", 2) != 0)
            xml_fail(xml, "an attribute without quotes");
        for (xml->at += 2; *xml->at != '"';) {
            if (!*xml->at || *xml->at == '<')
                xml_fail(xml, "an attribute without end");
            if (*xml->at == '&')
                xml_entity(xml);
            else
                xml->at++;
        }
        xml->at++;
    }
}

static inline void xml_tag(struct xml *xml)
{
    char name[32];
    bool closing = xml->at[1] == '/';

    xml->at += closing ? 2 : 1;
    xml_name(xml, name);
    if (closing) {
        if (xml->depth == 0 || strcmp(xml->open[--xml->depth], name) != 0)
            xml_fail(xml, "closes what is not open");
    } else {
        xml_attributes(xml);
        xml->elements++;
        if (*xml->at == '/') {
            xml->at++;
        } else {
            if (xml->depth >= 64)
                xml_fail(xml, "too deep");
            memcpy(xml->open[xml->depth++], name, sizeof name);
        }
    }
    if (*xml->at++ != '>')
        xml_fail(xml, "a tag without end");
}

/* The number of its elements. */
static inline size_t assert_xml(const char *text)
{
    static const char doctype[] = "<!DOCTYPE html>\n";
    struct xml xml = {.text = text, .at = text};

    if (strncmp(xml.at, doctype, sizeof doctype - 1) == 0)
        xml.at += sizeof doctype - 1;
    if (*xml.at != '<')
        xml_fail(&xml, "does not begin with an element");
    while (*xml.at) {
        if (*xml.at == '<')
            xml_tag(&xml);
        else if (*xml.at == '&')
            xml_entity(&xml);
        else if (*xml.at == '>' || ((unsigned char)*xml.at < 0x20 && *xml.at != '\n'))
            xml_fail(&xml, "a character that must not stand there");
        else if (xml.depth == 0 && *xml.at != '\n')
            xml_fail(&xml, "text outside of all elements");
        else
            xml.at++;
    }
    if (xml.depth > 0)
        xml_fail(&xml, xml.open[xml.depth - 1]);
    return xml.elements;
}

#endif
