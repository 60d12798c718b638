-- Roots with wide uncertain data: branches, parts of branches, slopes.
local ambit = require "ambit"

describe("roots with wide data", function()
  it("cuts the data where a proof needs it, and joins the branches", function()
    local p = ambit.between(4, 100)
    local r = ambit.roots { function(s) return s.x ^ 2 - p end, box = { x = { -20, 20 } } }
    assert.equal("complete", r.status)
    assert.equal(2, #r.proved)
    assert.is_true(r.proved[2].x:contains(2) and r.proved[2].x:contains(10))
    assert.is_true(r.proved[2].x.lo > 1.95 and r.proved[2].x.hi < 10.05)
    local never = ambit.roots { function(s) return s.x ^ 2 - p end, box = { x = { -20, 20 } }, parameter_pieces = 1 }
    assert.equal("unable", never.status)
    local fine = ambit.roots { function(s) return s.x ^ 2 - p end, box = { x = { -20, 20 } }, parameter_pieces = 512 }
    assert.is_true(fine.proved[2].x:width() < r.proved[2].x:width())
    assert.is_true(fine.proved[2].x:contains(2) and fine.proved[2].x:contains(10))
  end)

  it("lists roots that exist for a part of the data", function()
    local r = ambit.roots { function(s) return s.x ^ 2 - ambit.between(-1, 1) end, box = { x = { -3, 3 } } }
    assert.equal("unable", r.status)
    assert.equal(0, #r.proved)
    assert.equal(2, #r.partly)
    assert.is_true(r.partly[1].x:contains(-1) and r.partly[2].x:contains(1))
    assert.equal(1, #r.undecided)
    assert.is_true(r.undecided[1].x:contains(0) and r.undecided[1].x:width() < 0.2)
    assert.is_truthy(tostring(r):find("for a part of the uncertain data", 1, true))
  end)

  it("has no slope where the root jumps with a datum", function()
    for _, case in ipairs { { -1, 1, false }, { -1, 0, false }, { "0.5", 1, true } } do
      local p = ambit.between(case[1], case[2])
      local r = ambit.roots { function(s) return s.x + ambit.atan2(p, -1) end, box = { x = { -9, 9 } } }
      assert.equal(1, #r.proved)
      local d = r.proved[1].slope(p)
      assert.equal(case[3], d ~= nil)
      if d then assert.is_true(d.x:contains(1 / (1 + 0.7 ^ 2))) end -- atan2(p, -1)' = -1 / (1 + p^2)
    end
  end)

  it("encloses how a root moves with a datum", function()
    local p, q = ambit.between(2, "2.1"), ambit.around(3, "1%")
    local r = ambit.roots {
      function(s) return { s.x ^ 2 - p, s.x * s.y - q } end, box = { x = { 0, 3 }, y = { 0, 9 } },
    }
    local d = r.proved[1].slope(p) -- x = sqrt p, y = q / sqrt p
    for _, value in ipairs { 2, 2.05, 2.1 } do
      assert.is_true(d.x:contains(0.5 / math.sqrt(value)))
      assert.is_true(d.y:contains(-0.5 * 3 / value ^ 1.5))
    end
    assert.is_true(d.x:width() < 0.1)
    assert.is_false(d.x:contains(0.45))
    local e = r.proved[1].slope(q)
    assert.is_true(e.x:contains(0) and e.x:width() < 1e-12 and e.y:contains(1 / math.sqrt(2.05)))
    for _, wrong in ipairs { 3, "p", p + 1 } do assert.is_false((pcall(r.proved[1].slope, wrong))) end
  end)

  it("keeps an arm's elbows apart over a wide length", function()
    local l = ambit.between("0.5", 2)
    local r = ambit.roots {
      function(s)
        return { l * ambit.cos(s.a) + ambit.cos(s.a + s.b) - 1, l * ambit.sin(s.a) + ambit.sin(s.a + s.b) - 0.5 }
      end, box = { a = { -3, 3 }, b = { -3, 3 } },
    }
    assert.equal("complete", r.status)
    assert.equal(2, #r.proved)
    for i = 0, 20 do
      local length = 0.5 + 1.5 * i / 20
      for _, sign in ipairs { 1, -1 } do
        local b = sign * math.acos((1.25 - length * length - 1) / (2 * length))
        local a, count = math.atan(0.5, 1) - math.atan(math.sin(b), length + math.cos(b)), 0
        for _, point in ipairs(r.proved) do
          if point.b.lo <= b + 1e-12 and b - 1e-12 <= point.b.hi and point.a:contains(a) then count = count + 1 end
        end
        assert.is_true(count >= 1)
      end
    end
  end)

  it("takes every operator", function()
    for _, operator in ipairs { "auto", "newton", "krawczyk", "hansen_sengupta" } do
      local r = ambit.roots {
        function(s) return { s.x ^ 2 + s.y ^ 2 - ambit.around(4, "1%"), ambit.exp(s.x) - s.y - 2 } end,
        box = { x = { -3, 3 }, y = { -3, 3 } }, operator = operator,
      }
      assert.equal("complete", r.status)
      assert.equal(2, #r.proved)
      assert.is_true(r.proved[1].x:contains(-1.1032253126626885) and r.proved[2].x:contains(1.2663816528256687))
    end
  end)
end)
