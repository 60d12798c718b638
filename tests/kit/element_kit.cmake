# The conformance kit for elements, linked into the test that uses it; the tests of mechanisms load the element plugins.
set(element_kit ${PROJECT_SOURCE_DIR}/tests/kit/element_kit.c ${PROJECT_SOURCE_DIR}/tests/kit/element_stage.c)
foreach(test plugins.elements model.mechanism model.dynamics)
  if(TARGET test.${test})
    add_dependencies(test.${test} element_ground element_frame element_revolute element_prismatic element_rigid_link
      element_sloppy_joint element_rigid_body element_point_mass element_gravity element_joint_torque)
  endif()
endforeach()
if(TARGET test.plugins.elements)
  target_sources(test.plugins.elements PRIVATE ${element_kit})
endif()
