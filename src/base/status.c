#include "sfumato/status.h"

const char *sf_status_name(enum sf_status status)
{
    switch (status) {
    case SF_OK:
        return "ok";
    case SF_ERROR_INTERNAL:
        return "internal error";
    case SF_ERROR_USAGE:
        return "wrong usage";
    case SF_ERROR_SCENE:
        return "bad scene";
    case SF_ERROR_DEVICE:
        return "no suitable device";
    case SF_ERROR_DEVICE_LOST:
        return "device lost";
    case SF_ERROR_MEMORY:
        return "out of memory";
    case SF_ERROR_IO:
        return "input/output error";
    case SF_ERROR_INTERRUPTED:
        return "interrupted";
    }
    return "unknown status";
}
