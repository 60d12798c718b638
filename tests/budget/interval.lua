-- interval.lua -- the smallest question of all: it needs no plugin and no module beyond those of every scene.
local ambit = require "ambit"
print(ambit.interval "0.1")
