# The conformance kit for elements, linked into the tests that use it.
target_sources(test.plugins.elements PRIVATE ${PROJECT_SOURCE_DIR}/tests/kit/element_kit.c ${PROJECT_SOURCE_DIR}/tests/kit/element_stage.c)
add_dependencies(test.plugins.elements element_ground element_frame element_revolute element_prismatic element_rigid_link element_sloppy_joint
  element_rigid_body element_point_mass element_gravity element_joint_torque)
