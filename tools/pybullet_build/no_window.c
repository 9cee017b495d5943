/* PyBullet's connections to a window or another process, which this build leaves out.
 *
 * Each returns no connection, and p.connect(...) fails as if no server were running. */
#include <stddef.h>

#define NO_CONNECTION(function) void *function(void) { return NULL; }

NO_CONNECTION(b3CreateInProcessGraphicsServerAndConnectMainThreadSharedMemory)
NO_CONNECTION(b3CreateInProcessGraphicsServerAndConnectSharedMemory)
NO_CONNECTION(b3CreateInProcessPhysicsServerAndConnect)
NO_CONNECTION(b3CreateInProcessPhysicsServerAndConnectMainThread)
NO_CONNECTION(b3CreateInProcessPhysicsServerAndConnectMainThreadSharedMemory)
NO_CONNECTION(b3CreateInProcessPhysicsServerAndConnectSharedMemory)
NO_CONNECTION(b3CreateInProcessPhysicsServerFromExistingExampleBrowserAndConnect3)
NO_CONNECTION(b3CreateInProcessPhysicsServerFromExistingExampleBrowserAndConnect4)
