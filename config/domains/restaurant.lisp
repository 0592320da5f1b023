; A waiter robot in a restaurant: a PR2 with two arms, a torso that rises, and a tray on its base.
;
; Parts:  1  what the robot can do (operators)
;         2  how tasks break down (methods)
;         3  what follows from the state (axioms)
;         4  this restaurant (axioms without condition: facts that hold in every state)
; Another restaurant needs another part 4, another robot parts 1 and 3.
;
; State (one value each where marked *):
;   (RobotAt area)*                        (HasTorsoPosture posture)*
;   (HasArmPosture arm posture)* per arm   (Holding arm object-or-nothing)* per arm
;   (On object area)* per object           (At guest sitting-area)
;   (Type concept instance)                (HasTemperature object degrees)* per object, in Celsius
;   (TemperatureKnown object)              its temperature was measured
; Switches, absent by default:
;   (imagine place_object)      placing is imagined before the robot drives there
;   (imagine place_object_at)   the same, and imagination chooses the spot on the area
;   (observe pick_up_object)    the robot looks at an area before it picks from it
;   (imagine observe_objects_at)  the same, and imagination chooses from where it looks
; What imagination or execution found to fail; the planner refuses such a step:
;   (imagined_failure action arguments...)
;
; Areas: furniture has placing areas (pla). To reach one, the base stands in a manipulation area
; (ma) close to the furniture, which it approaches from a pre-manipulation area (pma) at a distance:
;   (Connected pla ma pma)
; Names are in lower case in plans; case is ignored.

(defdomain restaurant (

;;; 1. Operators ---------------------------------------------------------------------------------
; Preconditions also say what a step leaves undisturbed: the order in which steps must come, and
; which of them may run at the same time, follows from them.

; Drives to an area across the room, round obstacles. Not while close to furniture.
(:operator (!move_base ?area)
  ((RobotAt ?from) (not (Connected ?pla ?from ?pma)) (ready_to_drive))
  ((RobotAt ?from))
  ((RobotAt ?area)))

; The same with a motion set: how fast, how hard to accelerate.
(:operator (!move_base_param ?area ?motion_set)
  ((RobotAt ?from) (not (Connected ?pla ?from ?pma)) (ready_to_drive))
  ((RobotAt ?from))
  ((RobotAt ?area)))

; Drives straight, without looking at obstacles: close to furniture and back.
(:operator (!move_base_blind ?area)
  ((RobotAt ?from) (way_is_short ?from ?area))
  ((RobotAt ?from))
  ((RobotAt ?area)))

(:operator (!move_torso ?posture)
  ((HasTorsoPosture ?old))
  ((HasTorsoPosture ?old))
  ((HasTorsoPosture ?posture)))

; Folds the arms (armtuckedposture) or opens them (armuntuckedposture), the left arm's goal first.
(:operator (!tuck_arms ?left_goal ?right_goal)
  ((HasArmPosture leftarm1 ?left) (HasArmPosture rightarm1 ?right)
   (may_take leftarm1 ?left_goal) (may_take rightarm1 ?right_goal))
  ((HasArmPosture leftarm1 ?left) (HasArmPosture rightarm1 ?right))
  ((HasArmPosture leftarm1 ?left_goal) (HasArmPosture rightarm1 ?right_goal)))

; Ready to grasp, beside the body.
(:operator (!move_arm_to_side ?arm)
  ((HasArmPosture ?arm ?old) (may_swing ?arm ?old))
  ((HasArmPosture ?arm ?old))
  ((HasArmPosture ?arm armtosideposture)))

; Both arms hold upright before the body what they hold. Not with the torso in its lowest posture.
(:operator (!move_arms_to_carryposture)
  ((HasArmPosture leftarm1 ?left) (HasArmPosture rightarm1 ?right)
   (not (HasTorsoPosture torsodownposture)))
  ((HasArmPosture leftarm1 ?left) (HasArmPosture rightarm1 ?right))
  ((HasArmPosture leftarm1 armcarryposture) (HasArmPosture rightarm1 armcarryposture)))

; Always possible; but whatever stands there: who takes or places something does not do it meanwhile,
; and stays on its side of the look.
(:operator (!observe_objects_on_area ?area)
  ((RobotAt ?ma) (Connected ?area ?ma ?pma)
   (forall (?object) ((On ?object ?area)) ((On ?object ?area))))
  ()
  ())

; The same from another height and place beside the area where the robot stands; it comes back.
(:operator (!observe_objects_at ?area ?standing_area ?torso ?place)
  ((RobotAt ?standing_area) (Connected ?area ?standing_area ?pma) (HasTorsoPosture torsoupposture)
   (forall (?object) ((On ?object ?area)) ((On ?object ?area))))
  ()
  ())

; Looks at the area until the thermal camera has told how warm the object is, of which nobody knows.
; What it will tell is not known before; that it changes something about it says the deleted atom.
(:operator (!measure_temperature ?object ?area)
  ((On ?object ?area) (RobotAt ?ma) (Connected ?area ?ma ?pma)
   (not (HasTemperature ?object ?any)))
  ((forall (?degrees) ((HasTemperature ?object ?degrees)) ((HasTemperature ?object ?degrees))))
  ((TemperatureKnown ?object)))

(:operator (!pick_up_object ?object ?arm)
  ((On ?object ?area) (RobotAt ?ma) (Connected ?area ?ma ?pma)
   (Holding ?arm nothing) (HasArmPosture ?arm armtosideposture) (HasTorsoPosture torsoupposture))
  ((On ?object ?area) (Holding ?arm nothing))
  ((Holding ?arm ?object)))

(:operator (!place_object ?object ?arm ?area)
  ((Holding ?arm ?object) (different ?object nothing) (RobotAt ?ma) (Connected ?area ?ma ?pma)
   (HasArmPosture ?arm armtosideposture) (HasTorsoPosture torsoupposture))
  ((Holding ?arm ?object))
  ((Holding ?arm nothing) (On ?object ?area)))

(:operator (!place_object_at ?object ?arm ?area ?spot)
  ((Holding ?arm ?object) (different ?object nothing) (RobotAt ?ma) (Connected ?area ?ma ?pma)
   (HasArmPosture ?arm armtosideposture) (HasTorsoPosture torsoupposture))
  ((Holding ?arm ?object))
  ((Holding ?arm nothing) (On ?object ?area)))

; Close to furniture the arm has no room to reach its own tray.
(:operator (!place_on_tray ?arm ?object)
  ((Holding ?arm ?object) (different ?object nothing)
   (RobotAt ?at) (not (Connected ?pla ?at ?pma))
   (HasArmPosture ?arm armtosideposture) (HasTorsoPosture torsoupposture))
  ((Holding ?arm ?object))
  ((Holding ?arm nothing) (On ?object trayarea1)))

(:operator (!pick_up_from_tray ?arm ?object)
  ((On ?object trayarea1) (RobotAt ?at) (not (Connected ?pla ?at ?pma))
   (Holding ?arm nothing) (HasArmPosture ?arm armtosideposture) (HasTorsoPosture torsoupposture))
  ((On ?object trayarea1) (Holding ?arm nothing))
  ((Holding ?arm ?object)))

; Imagines a step that comes later, with all combinations of the alternatives: one list for each
; argument of the action. It changes nothing in the world and costs the robot nothing; it runs
; beside other steps and may begin as soon as it is known what the imagined step will find.
(:operator (!imagine ?action . ?lists)
  ()
  ()
  ()
  0)

; From here on the plan only guesses that the object is hot. It does not come to that: as soon as the
; temperature is known this step cannot be done, and what is left of the task is planned again.
(:operator (!!temperature_unknown ?object ?area)
  ((On ?object ?area) (TemperatureKnown ?object) (not (HasTemperature ?object ?degrees)))
  ()
  ()
  0)

;;; 2. Methods -----------------------------------------------------------------------------------
; Torso and arms are told one after the other. That costs no time: nothing orders these steps but
; their preconditions, so that they run side by side where they can. `:unordered` would allow the
; same and have the search try every interleaving.

; Brings the guest a coffee, to the right of the seat, else to the left.
(:method (serve_coffee_to_guest ?guest)
  served
  ((At ?guest ?seat) (place_in ?seat ?area ?rank) (Type coffee ?mug) (On ?mug ?area))
  ((leave_manipulation_pose))

  serve
  (:sort-by ?rank ((At ?guest ?seat) (coffee_to_serve ?mug ?rank)))
  ((move_object ?mug ?seat)))

; The same with a coffee that is hot. Where none is known to be, the robot looks how warm the next one
; is whose temperature nobody knows; a cold one is never served.
(:method (serve_hot_coffee_to_guest ?guest)
  served
  ((At ?guest ?seat) (place_in ?seat ?area ?rank) (Type coffee ?mug) (On ?mug ?area)
   (hot ?mug))
  ((leave_manipulation_pose))

  hot
  (:sort-by ?rank ((At ?guest ?seat) (coffee_to_serve ?mug ?rank) (hot ?mug)))
  ((move_object ?mug ?seat))

  temperature_unknown
  (:sort-by ?rank ((At ?guest ?seat) (coffee_to_serve ?mug ?rank)
                   (not (HasTemperature ?mug ?degrees))
                   (On ?mug ?area) (Connected ?area ?ma ?pma) (arm_for ?mug ?arm)))
  ((assume_manipulation_pose ?ma ?pma ?arm) (!measure_temperature ?mug ?area)
   (!!temperature_unknown ?mug ?area) (move_object ?mug ?seat)))

; Carries what stands on the table to the counter, one thing after the other.
(:method (clear_table ?table ?counter)
  hand_full
  (:first (Holding ?arm ?object) (different ?object nothing))
  ((put_object ?object ?counter) (clear_table ?table ?counter))

  table_full
  (:first (On ?object ?area) (hasPlacingArea ?table ?area ?rank))
  ((move_object ?object ?counter) (clear_table ?table ?counter))

  clear
  ()
  ((leave_manipulation_pose)))

; Takes an object from one place to another on the tray, as tall things are carried. Places are
; furniture or one of its placing areas.
(:method (carry_object_on_tray ?object ?from ?to)  ; the last bit of an interrupted way
  (:sort-by ?rank ((Holding ?arm ?object) (place_in ?to ?area ?rank)
                   (Connected ?area ?ma ?pma) (stands_at ?ma ?pma)))
  ((put_object_on_area ?object ?area)))

(:method (carry_object_on_tray ?object ?from ?to)
  delivered
  ((place_in ?to ?area ?rank) (On ?object ?area))
  ((leave_manipulation_pose))

  by_tray
  ()
  ((load_tray ?object ?from) (unload_tray ?object ?to)))

(:method (load_tray ?object ?from)
  on_tray
  ((On ?object trayarea1))
  ()

  in_hand
  ((Holding ?arm ?object))
  ((put_on_tray ?object))

  at_source
  ((place_in ?from ?area ?rank) (On ?object ?area))
  ((get_object ?object) (put_on_tray ?object)))

(:method (put_on_tray ?object)
  ((Holding ?arm ?object))
  ((leave_manipulation_pose) (prepare_arms ?arm) (!place_on_tray ?arm ?object)))

(:method (unload_tray ?object ?to)
  (:sort-by ?rank ((place_in ?to ?area ?rank) (Connected ?area ?ma ?pma)))
  ((drive_robot ?pma) (take_from_tray ?object) (put_object_on_area ?object ?area)))

(:method (take_from_tray ?object)
  ((On ?object trayarea1) (arm_for ?object ?arm))
  ((prepare_arms ?arm) (!pick_up_from_tray ?arm ?object)))

; To a placing area, a piece of furniture or a seat, in the hand.
(:method (move_object ?object ?where)
  ()
  ((get_object ?object) (put_object ?object ?where)))

(:method (get_object ?object)
  held
  ((Holding ?arm ?object))
  ()

  on_tray
  ((On ?object trayarea1))
  ((leave_manipulation_pose) (take_from_tray ?object))

  on_furniture
  ((On ?object ?area) (Connected ?area ?ma ?pma) (arm_for ?object ?arm))
  ((assume_manipulation_pose ?ma ?pma ?arm) (look_before_grasp ?area)
   (!pick_up_object ?object ?arm)))

; With the switch (imagine observe_objects_at) poses of torso and base are imagined; the robot's own
; stands in the plan until the answer takes its place. When all are known to fail, the robot looks
; from where it stands, and what it sees there decides.
(:method (look_before_grasp ?area)
  from_the_best_pose
  ((imagine observe_objects_at) (Connected ?area ?ma ?pma)
   (setof (?torso ?place) (may_look_from ?area ?ma ?torso ?place) ?poses)
   (setof ?torso (may_look_from ?area ?ma ?torso ?any_place) ?torsos)
   (setof ?place (may_look_from ?area ?ma ?any_torso ?place) ?places)
   (assign ?chosen_torso (first (first '?poses))) (assign ?chosen_place (second (first '?poses))))
  ((!imagine !observe_objects_at (?area) (?ma) ?torsos ?places)
   (!observe_objects_at ?area ?ma ?chosen_torso ?chosen_place))

  from_where_it_stands
  ((or (imagine observe_objects_at) (observe pick_up_object)))
  ((!observe_objects_on_area ?area))

  trust
  ()
  ())

; Where there are several areas, each is tried in turn, the one with the lowest rank first.
(:method (put_object ?object ?where)
  (:sort-by ?rank ((place_in ?where ?area ?rank)))
  ((put_object_on_area ?object ?area)))

; With the switch (imagine place_object_at) spots of the area are imagined; `any` stands in the plan
; until the answer takes its place. Spots known to fail are left out.
(:method (put_object_on_area ?object ?area)
  ((imagine place_object_at) (Holding ?arm ?object) (Connected ?area ?ma ?pma)
   (setof ?spot (may_place_at ?object ?arm ?area ?spot) ?spots) (preferred_spot ?spots ?chosen))
  ((!imagine !place_object_at (?object) (?arm) (?area) ?spots)
   (assume_manipulation_pose ?ma ?pma ?arm)
   (!place_object_at ?object ?arm ?area ?chosen) (leave_manipulation_pose)))

(:method (put_object_on_area ?object ?area)
  ((Holding ?arm ?object) (Connected ?area ?ma ?pma))
  ((imagine_placing ?object ?arm ?area) (assume_manipulation_pose ?ma ?pma ?arm)
   (!place_object ?object ?arm ?area) (leave_manipulation_pose)))

; Nothing is left open here: imagination only says whether placing will succeed.
(:method (imagine_placing ?object ?arm ?area)
  imagined
  ((imagine place_object) (not (placing_fails ?object ?arm ?area)))
  ((!imagine !place_object (?object) (?arm) (?area)))

  trusted
  ((not (imagine place_object)) (not (imagine place_object_at)))
  ())

(:method (drive_robot ?area)
  there
  ((RobotAt ?area))
  ()

  from_furniture
  (:first (RobotAt ?ma) (Connected ?pla ?ma ?pma))
  ((!move_base_blind ?pma) (drive_robot ?area))

  across_the_room
  ()
  ((assume_driving_pose) (move_robot ?area)))

; With something on the tray it matters how the robot drives: the motion sets are imagined, and
; `fast` stands in the plan until the answer takes its place. Sets known to fail are left out.
(:method (move_robot ?area)
  with_tray
  ((tray_loaded) (setof ?set (may_drive ?area ?set) ?sets) (preferred ?sets ?motion_set))
  ((!imagine !move_base_param (?area) ?sets) (!move_base_param ?area ?motion_set))

  without_load
  ((not (tray_loaded)))
  ((!move_base ?area)))

(:method (assume_driving_pose)
  ((load ?load) (driving_pose ?load ?torso ?arms))
  ((adapt_torso ?torso) (adapt_arms ?arms)))

; Close to the furniture, torso up, the working arm at the side. Arms and torso move before the
; robot approaches: at the furniture there is no room for it.
(:method (assume_manipulation_pose ?ma ?pma ?arm)
  ready
  ((RobotAt ?ma) (HasTorsoPosture torsoupposture) (HasArmPosture ?arm armtosideposture))
  ()

  approach
  ()
  ((drive_robot ?pma) (prepare_arms ?arm) (!move_base_blind ?ma)))

(:method (leave_manipulation_pose)
  leave
  (:first (RobotAt ?ma) (Connected ?pla ?ma ?pma))
  ((!move_base_blind ?pma))

  clear
  ()
  ())

(:method (prepare_arms ?arm)
  ((other_arm ?arm ?other))
  ((adapt_torso torsoupposture) (move_to_side ?arm) (clear_arm ?other)))

(:method (adapt_torso ?posture)
  done
  ((HasTorsoPosture ?posture))
  ()

  adapt
  ()
  ((!move_torso ?posture)))

(:method (adapt_arms ?posture)
  done
  ((HasArmPosture leftarm1 ?posture) (HasArmPosture rightarm1 ?posture))
  ()

  tuck
  ((same ?posture armtuckedposture))
  ((!tuck_arms armtuckedposture armtuckedposture))

  carry
  ((same ?posture armcarryposture))
  ((!move_arms_to_carryposture)))

; Two folded arms lie in each other's way: the working arm is opened first.
(:method (move_to_side ?arm)
  done
  ((HasArmPosture ?arm armtosideposture))
  ()

  both_folded
  ((HasArmPosture leftarm1 armtuckedposture) (HasArmPosture rightarm1 armtuckedposture))
  ((open_arm ?arm) (!move_arm_to_side ?arm))

  free
  ()
  ((!move_arm_to_side ?arm)))

(:method (open_arm leftarm1)
  ()
  ((!tuck_arms armuntuckedposture armtuckedposture)))

(:method (open_arm rightarm1)
  ()
  ((!tuck_arms armtuckedposture armuntuckedposture)))

; The arm that does not work must not hang over the furniture.
(:method (clear_arm ?arm)
  clear
  ((HasArmPosture ?arm ?posture) (clear_of_furniture ?arm ?posture))
  ()

  stretched
  ()
  ((!move_arm_to_side ?arm)))

;;; 3. Axioms ------------------------------------------------------------------------------------

(:- (same ?x ?x) ())
(:- (different ?x ?y) ((not (same ?x ?y))))

; Placing areas that belong to a seat (right hand first), to furniture, or to themselves.
(:- (place_in ?seat ?area 1) ((hasPlacingAreaRight ?seat ?area)))
(:- (place_in ?seat ?area 2) ((hasPlacingAreaLeft ?seat ?area)))
(:- (place_in ?furniture ?area ?rank) ((hasPlacingArea ?furniture ?area ?rank)))
(:- (place_in ?area ?area 1) ((Connected ?area ?ma ?pma)))

; A coffee that no guest has yet, the nearest first.
(:- (coffee_to_serve ?mug 1) ((Type coffee ?mug) (Holding ?arm ?mug)))
(:- (coffee_to_serve ?mug 2) ((Type coffee ?mug) (On ?mug trayarea1)))
(:- (coffee_to_serve ?mug 3)
  ((Type coffee ?mug) (On ?mug ?area) (hasPlacingArea ?counter ?area ?rank)
   (Type counter ?counter)))

; From what temperature on, in degrees Celsius, a coffee is hot.
(:- (hot ?object) ((HasTemperature ?object ?degrees) (call >= ?degrees 45)))

; The right arm works; the left one when the right is full or known to fail.
(:- (arm_for ?object ?arm)
  right
  ((Holding rightarm1 nothing) (not (grasping_fails ?object rightarm1)) (same ?arm rightarm1))
  left
  ((Holding leftarm1 nothing) (same ?arm leftarm1)))

(:- (grasping_fails ?object ?arm)
  ((On ?object trayarea1) (failed pick_up_from_tray !pick_up_from_tray ?arm ?object)))
(:- (grasping_fails ?object ?arm)
  ((failed pick_up_object !pick_up_object ?object ?arm)))

(:- (placing_fails ?object ?arm ?area)
  ((imagined_failure place_object ?object ?arm ?area)))
(:- (placing_fails ?object ?arm ?area)
  ((imagined_failure !place_object ?object ?arm ?area)))

(:- (may_place_at ?object ?arm ?area ?spot)
  ((spot ?spot) (not (imagined_failure place_object_at ?object ?arm ?area ?spot))
   (not (imagined_failure !place_object_at ?object ?arm ?area ?spot))))

(:- (preferred_spot ?spots ?spot)
  any
  ((eval (member 'any '?spots)) (same ?spot any))
  another
  ((assign ?spot (first '?spots))))

(:- (may_look_from ?area ?ma ?torso ?place)
  ((torso_posture ?torso) (base_place ?place)
   (not (imagined_failure observe_objects_at ?area ?ma ?torso ?place))
   (not (imagined_failure !observe_objects_at ?area ?ma ?torso ?place))))

; An action may be named with its exclamation mark or without.
(:- (failed ?name ?marked_name ?x ?y) ((imagined_failure ?name ?x ?y)))
(:- (failed ?name ?marked_name ?x ?y) ((imagined_failure ?marked_name ?x ?y)))

(:- (may_drive ?area ?set)
  ((motion_set ?set) (not (failed move_base_param !move_base_param ?area ?set))))

(:- (preferred ?sets ?set)
  fast
  ((eval (member 'fast '?sets)) (same ?set fast))
  any
  ((assign ?set (first '?sets))))

(:- (stands_at ?ma ?pma) ((RobotAt ?ma)))
(:- (stands_at ?ma ?pma) ((RobotAt ?pma)))

(:- (tray_loaded) ((On ?object trayarea1)))

(:- (load none) ((Holding leftarm1 nothing) (Holding rightarm1 nothing)
                 (not (On ?object trayarea1))))
(:- (load hand) ((Holding ?arm ?held) (different ?held nothing) (not (On ?object trayarea1))))
(:- (load tray) ((Holding leftarm1 nothing) (Holding rightarm1 nothing) (On ?object trayarea1)))
(:- (load hand_and_tray) ((Holding ?arm ?held) (different ?held nothing) (On ?object trayarea1)))

; Torso and arms while driving. A loaded tray needs the torso up: the folded arms pass above it.
(:- (driving_pose none torsodownposture armtuckedposture) ())
(:- (driving_pose hand torsomiddleposture armcarryposture) ())
(:- (driving_pose tray torsoupposture armtuckedposture) ())
(:- (driving_pose hand_and_tray torsoupposture armcarryposture) ())

(:- (ready_to_drive)
  ((load ?load) (driving_pose ?load ?torso ?arms) (HasTorsoPosture ?torso)
   (HasArmPosture leftarm1 ?arms) (HasArmPosture rightarm1 ?arms)))

; Between an area close to furniture and the one before it. Arms and torso stay as they are.
(:- (way_is_short ?from ?to)
  approach
  ((Connected ?pla ?to ?from) (HasTorsoPosture torsoupposture)
   (HasArmPosture leftarm1 ?left) (clear_of_furniture leftarm1 ?left)
   (HasArmPosture rightarm1 ?right) (clear_of_furniture rightarm1 ?right))
  retreat
  ((Connected ?pla ?from ?to) (HasTorsoPosture ?torso)
   (HasArmPosture leftarm1 ?left) (HasArmPosture rightarm1 ?right)))

; Folded or carrying, the right arm reaches farther forward than the left one, over the edge; so
; does what an arm carries.
(:- (clear_of_furniture ?arm armtosideposture) ())
(:- (clear_of_furniture leftarm1 armtuckedposture) ())
(:- (clear_of_furniture leftarm1 armcarryposture) ((Holding leftarm1 nothing)))

; Only an empty arm is folded.
(:- (may_take ?arm armtuckedposture) ((Holding ?arm nothing)))
(:- (may_take ?arm armuntuckedposture) ())

; A folded arm swings out only when the other one is not folded around it.
(:- (may_swing ?arm ?posture)
  open
  ((different ?posture armtuckedposture))
  folded
  ((other_arm ?arm ?other) (HasArmPosture ?other ?its_posture)
   (different ?its_posture armtuckedposture)))

(:- (other_arm leftarm1 rightarm1) ())
(:- (other_arm rightarm1 leftarm1) ())

; Spots, poses to look from and motion sets, in the order in which they are listed for imagination.
(:- (spot any) ())
(:- (spot middle) ())
(:- (spot left) ())
(:- (spot right) ())
(:- (spot front) ())
(:- (spot back) ())

(:- (torso_posture torsoupposture) ())
(:- (torso_posture torsomiddleposture) ())
(:- (torso_posture torsodownposture) ())

(:- (base_place default) ())
(:- (base_place left) ())
(:- (base_place right) ())
(:- (base_place behind) ())

(:- (motion_set slow) ())
(:- (motion_set fast) ())

;;; 4. The restaurant ----------------------------------------------------------------------------
; Poses of the areas: the frames of worlds/restaurant.world.

(:- (Type counter counter1) ())
(:- (Type table table1) ())
(:- (Type table table2) ())

; The number is the order in which the areas are tried.
(:- (hasPlacingArea counter1 placingareaeastrightcounter1 1) ())
(:- (hasPlacingArea table1 placingareawestlefttable1 1) ())
(:- (hasPlacingArea table1 placingareaeastrighttable1 2) ())
(:- (hasPlacingArea table1 placingareaeastlefttable1 3) ())
(:- (hasPlacingArea table1 placingareawestrighttable1 4) ())
(:- (hasPlacingArea table2 placingareanorthlefttable2 1) ())
(:- (hasPlacingArea table2 placingareasouthrighttable2 2) ())
(:- (hasPlacingArea table2 placingareanorthrighttable2 3) ())
(:- (hasPlacingArea table2 placingareasouthlefttable2 4) ())

(:- (Connected placingareaeastrightcounter1
               manipulationareaeastcounter1 premanipulationareaeastcounter1) ())
(:- (Connected placingareawestlefttable1
               manipulationareanorthtable1 premanipulationareanorthtable1) ())
(:- (Connected placingareaeastrighttable1
               manipulationareanorthtable1 premanipulationareanorthtable1) ())
(:- (Connected placingareaeastlefttable1
               manipulationareasouthtable1 premanipulationareasouthtable1) ())
(:- (Connected placingareawestrighttable1
               manipulationareasouthtable1 premanipulationareasouthtable1) ())
(:- (Connected placingareanorthlefttable2
               manipulationareaeasttable2 premanipulationareaeasttable2) ())
(:- (Connected placingareasouthrighttable2
               manipulationareaeasttable2 premanipulationareaeasttable2) ())
(:- (Connected placingareanorthrighttable2
               manipulationareawesttable2 premanipulationareawesttable2) ())
(:- (Connected placingareasouthlefttable2
               manipulationareawesttable2 premanipulationareawesttable2) ())

; Left and right as the guest sees them.
(:- (hasPlacingAreaRight sittingareawesttable1 placingareawestrighttable1) ())
(:- (hasPlacingAreaLeft sittingareawesttable1 placingareawestlefttable1) ())
(:- (hasPlacingAreaRight sittingareaeasttable1 placingareaeastrighttable1) ())
(:- (hasPlacingAreaLeft sittingareaeasttable1 placingareaeastlefttable1) ())
(:- (hasPlacingAreaRight sittingareanorthtable2 placingareanorthrighttable2) ())
(:- (hasPlacingAreaLeft sittingareanorthtable2 placingareanorthlefttable2) ())
(:- (hasPlacingAreaRight sittingareasouthtable2 placingareasouthrighttable2) ())
(:- (hasPlacingAreaLeft sittingareasouthtable2 placingareasouthlefttable2) ())

))
