# The demo's content, compiled by assetc as part of the build and kept until a source or assetc changes: shapes of
# penumbra-content, meshes and environments of Debian packages. They land in <build>/assets, beside bin.
set(PENUMBRA_ASSET_DIR ${PROJECT_BINARY_DIR}/assets)
set(shape_dir ${CMAKE_CURRENT_BINARY_DIR}/shapes)
set(assets "")

# penumbra_demo_mesh(NAME SOURCE ARG…): bakes SOURCE to NAME.glb, with levels of detail for the shadow maps of beams;
# ARG… go to assetc bake.
function(penumbra_demo_mesh NAME SOURCE)
    set(output ${PENUMBRA_ASSET_DIR}/${NAME}.glb)
    add_custom_command(OUTPUT ${output}
        COMMAND assetc bake ${SOURCE} -o ${output} --lods 4 ${ARGN}
        DEPENDS assetc ${SOURCE} COMMENT "Asset ${NAME}.glb" VERBATIM)
    set(assets ${assets} ${output} PARENT_SCOPE)
endfunction()

foreach(shape ball chess_pawn gear mug panel rounded_cube teapot torus_knot floor floor_coarse)
    set(source ${shape_dir}/${shape}.obj)
    add_custom_command(OUTPUT ${source}
        COMMAND penumbra-content ${shape} -o ${source} DEPENDS penumbra-content COMMENT "Shape ${shape}" VERBATIM)
    if(shape MATCHES "^floor")
        penumbra_demo_mesh(${shape} ${source} --no-field) # the ground is in the light, see systems/frame_constants.h
    else()
        penumbra_demo_mesh(${shape} ${source})
    endif()
endforeach()

foreach(shape beach_ball painted_knot)
    set(source ${shape_dir}/${shape}.glb)
    add_custom_command(OUTPUT ${source}
        COMMAND penumbra-content ${shape} -o ${source} DEPENDS penumbra-content COMMENT "Shape ${shape}" VERBATIM)
    penumbra_demo_mesh(${shape} ${source})
endforeach()

# Lights: descriptions beside the picture that one of them shows.
set(light_dir ${CMAKE_CURRENT_BINARY_DIR}/lights)
set(picture ${light_dir}/picture.png)
add_custom_command(OUTPUT ${picture}
    COMMAND penumbra-content picture -o ${picture} DEPENDS penumbra-content COMMENT "Picture picture.png" VERBATIM)
foreach(light ball_lamp picture_lamp)
    configure_file(${CMAKE_CURRENT_SOURCE_DIR}/content/lights/${light}.json ${light_dir}/${light}.json COPYONLY)
    set(output ${PENUMBRA_ASSET_DIR}/${light}.glb)
    add_custom_command(OUTPUT ${output} COMMAND assetc light ${light_dir}/${light}.json -o ${output}
        DEPENDS assetc ${light_dir}/${light}.json ${picture} COMMENT "Asset ${light}.glb" VERBATIM)
    list(APPEND assets ${output})
endforeach()

# penumbra_package_file(VARIABLE PACKAGE FILE): a file that a Debian package installs; without it there is no demo content.
function(penumbra_package_file VARIABLE PACKAGE FILE)
    if(NOT EXISTS ${FILE})
        message(FATAL_ERROR "${FILE} is missing: run scripts/setup, or apt-get install ${PACKAGE}; "
            "-DPENUMBRA_BUILD_DEMO=OFF builds without the demo")
    endif()
    set(${VARIABLE} ${FILE} PARENT_SCOPE)
endfunction()

penumbra_package_file(bunny glmark2-data /usr/share/glmark2/models/bunny.obj)
penumbra_package_file(knight brutalchess /usr/share/games/brutalchess/models/knight.obj)
penumbra_demo_mesh(bunny ${bunny})
penumbra_demo_mesh(knight ${knight})

set(world /usr/share/blender/datafiles/studiolights/world)
foreach(environment city courtyard forest interior night studio sunrise sunset)
    penumbra_package_file(source blender-data ${world}/${environment}.exr)
    set(output ${PENUMBRA_ASSET_DIR}/${environment}.env)
    add_custom_command(OUTPUT ${output} COMMAND assetc environment ${source} -o ${output}
        DEPENDS assetc ${source} COMMENT "Asset ${environment}.env" VERBATIM)
    list(APPEND assets ${output})
endforeach()

add_custom_target(demo-assets ALL DEPENDS ${assets})
