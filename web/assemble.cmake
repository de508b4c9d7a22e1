# cmake -DVIEWER=web/viewer -DTHREE=node_modules/three -DOUTPUT=page.html -P assemble.cmake: puts the
# styles, three.js with its licence, and our modules into page.html. Each module is text in an
# element of its own; boot.js makes modules of them in the browser.
cmake_minimum_required(VERSION 3.25)

# Text that no browser takes for the end of a script element.
function(read_text path text)
    file(READ ${path} content)
    string(REPLACE "</script" "<\\/script" content "${content}")
    string(REPLACE "<!--" "<\\!--" content "${content}")
    set(${text} "${content}" PARENT_SCOPE)
endfunction()

function(add_module name path)
    read_text(${path} content)
    string(APPEND modules "<script type=\"text/plain\" class=\"module\" data-name=\"${name}\">\n")
    string(APPEND modules "${content}</script>\n")
    set(modules "${modules}" PARENT_SCOPE)
endfunction()

add_module(three ${THREE}/build/three.module.js)
add_module(three/build/three.core.js ${THREE}/build/three.core.js)
foreach(addon controls/OrbitControls loaders/GLTFLoader loaders/KTX2Loader loaders/EXRLoader
        loaders/HDRLoader utils/BufferGeometryUtils utils/SkeletonUtils utils/WorkerPool
        math/ColorSpaces libs/ktx-parse.module libs/zstddec.module libs/fflate.module
        libs/meshopt_decoder.module)
    add_module(three/addons/${addon}.js ${THREE}/examples/jsm/${addon}.js)
endforeach()
add_module(alpenglow/three-blend.js ${VIEWER}/../three-blend.js)
file(GLOB ours RELATIVE ${VIEWER} ${VIEWER}/*.js)
list(REMOVE_ITEM ours boot.js)
foreach(file ${ours})
    add_module(alpenglow/${file} ${VIEWER}/${file})
endforeach()

file(READ ${VIEWER}/page.html page)
file(READ ${VIEWER}/page.css styles)
read_text(${VIEWER}/boot.js boot)
read_text(${THREE}/LICENSE licence)
foreach(part styles modules boot licence)
    string(REPLACE "<!-- ${part} -->" "${${part}}" page "${page}")
endforeach()
file(WRITE ${OUTPUT} "${page}")
