/* The folder of -o: what is in it, and what may be replaced. */
#include "verify.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../console.h"
#include "../files.h"

enum { HEAD_BYTES = 1024, NAME_LETTERS = 60, NAME_ROOM = 192 };

static enum sf_status out_of_memory(void)
{
    return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
}

char *sf_verify_folder_path(const struct sf_verify *verify, const char *name)
{
    size_t room = strlen(verify->arguments->folder) + strlen(name) + 2;
    char *path = malloc(room);

    if (path)
        snprintf(path, room, "%s/%s", verify->arguments->folder, name);
    return path;
}

/* Letters, digits and dots stay; the rest becomes '_', so that the name needs no quoting anywhere. */
static void name_case(struct sf_verify_case *result, size_t number)
{
    char name[NAME_LETTERS + 1];
    size_t length = 0;

    for (const char *at = result->name; *at && length < NAME_LETTERS; at++) {
        bool plain = (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || (*at >= '0' && *at <= '9') ||
                     *at == '.' || *at == '-';

        name[length++] = plain ? *at : '_';
    }
    name[length] = '\0';
    snprintf(result->base, sizeof result->base, "%02zu-%s-%u", number, name, result->frame);
}

void sf_verify_picture_name(const struct sf_verify_case *result, const char *method, bool difference, char *name,
                            size_t room)
{
    snprintf(name, room, "%s-%s%s.png", result->base, method ? method : "reference", difference ? "-difference" : "");
}

/* ---- what is there already ---- */

/* Whether the folder's page is one of ours; false when there is none. */
static bool has_our_page(const char *path)
{
    char head[HEAD_BYTES + 1];
    FILE *file = fopen(path, "rb");
    size_t count;

    if (!file)
        return false;
    count = fread(head, 1, HEAD_BYTES, file);
    fclose(file);
    head[count] = '\0';
    return strstr(head, SF_VERIFY_MARK) != NULL;
}

static enum sf_status check_file(const struct sf_verify *verify, const char *name, bool ours)
{
    char *path = sf_verify_folder_path(verify, name);
    enum sf_status status = SF_OK;
    struct stat info;

    if (!path)
        return out_of_memory();
    /* A dangling link is there as well: the rename would replace it. */
    if (lstat(path, &info) != 0)
        status = SF_OK;
    else if (!S_ISREG(info.st_mode))
        status = sf_console_fail(SF_ERROR_IO, "%s: is no file", path);
    else if (!verify->arguments->overwrite)
        status = sf_console_fail(SF_ERROR_IO, "%s: exists (--overwrite replaces what verify made)", path);
    else if (!ours)
        status = sf_console_fail(SF_ERROR_IO, "%s: exists, and no page in %s says that verify made it", path,
                                 verify->arguments->folder);
    free(path);
    return status;
}

static enum sf_status check_case(const struct sf_verify *verify, const struct sf_verify_case *result, bool ours)
{
    char name[NAME_ROOM];
    enum sf_status status;

    sf_verify_picture_name(result, NULL, false, name, sizeof name);
    status = check_file(verify, name, ours);
    for (size_t i = 0; i < 2 * verify->entry_count && !status; i++) {
        if (verify->entries[i / 2].sweep > 0)
            continue;
        sf_verify_picture_name(result, verify->entries[i / 2].method, i % 2, name, sizeof name);
        status = check_file(verify, name, ours);
    }
    return status;
}

static enum sf_status check_files(const struct sf_verify *verify)
{
    static const char *const names[] = {"index.html", "plot.svg", "verify.json"};
    char *page = sf_verify_folder_path(verify, names[0]);
    enum sf_status status = page ? sf_folder_check(page) : out_of_memory();
    bool ours = page && has_our_page(page);

    free(page);
    for (size_t i = 0; i < sizeof names / sizeof *names && !status; i++)
        status = check_file(verify, names[i], ours);
    for (size_t i = 0; i < verify->case_total && !status; i++)
        status = check_case(verify, &verify->cases[i], ours);
    return status;
}

enum sf_status sf_verify_folder_open(struct sf_verify *verify)
{
    const char *folder = verify->arguments->folder;

    for (size_t i = 0; i < verify->case_total; i++)
        name_case(&verify->cases[i], i + 1);
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return sf_console_fail(SF_ERROR_IO, "--output %s: cannot be made: %s%s", folder, strerror(errno),
                               errno == ENOENT ? " (mkdir -p makes the folders above it)" : "");
    return check_files(verify);
}
